/// The IMU text of KF-GINS and the tools around it: seven numbers a line between blanks and no header, GNSS seconds of
/// the week, then the increments of angle [rad] and of velocity [m/s] since the line before. Source: KF-GINS, "IMU
/// data" of its manual.
///
/// The increments are delivered as mean rates over the time between the stamps; the first line, whose interval is not
/// known, is left out. Nothing in the text says what it is; it is recognised by physics: at rest and in a car the
/// velocity grows by standard gravity times the interval (within 2 % in the median of the first lines), at 20 Hz or
/// more. A table of accelerations fails this by a factor of 20 and more.
#include "core/read/dialect.hpp"
#include "core/read/formats.hpp"
#include "core/read/text_lines.hpp"
#include "core/read/text_numbers.hpp"
#include "core/signal/missing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace driftlab::formats {
namespace {

constexpr std::size_t kCells = 7;
constexpr std::size_t kLongestLine = 1024;
constexpr std::size_t kLeastLines = 8;
constexpr std::size_t kMostLines = 200;
constexpr double kWeek = 604800.0;
constexpr double kLongestInterval = 0.05;
constexpr double kGravity = 9.80665;

using Line = std::array<double, kCells>;

/// Nothing where the line is not seven numbers between blanks. `cells` says how many there are.
std::optional<Line> read_line(std::string_view line, std::size_t& cells) {
  Line values{};
  cells = 0;
  bool numbers = true;
  while (!(line = text::trim(line)).empty()) {
    const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
    const auto value = text::number_of(line.substr(0, end));
    numbers = numbers && value;
    if (cells < kCells) {
      values[cells] = value.value_or(0.0);
    }
    ++cells;
    line.remove_prefix(end);
  }
  return numbers && cells == kCells ? std::optional(values) : std::nullopt;
}

int sniff(std::string_view head) {
  std::vector<double> gravity;
  std::optional<Line> before;
  std::size_t odd = 0;  // repeats and gaps
  for (std::size_t end = head.find('\n'); end != std::string_view::npos && gravity.size() < kMostLines;
       end = head.find('\n')) {
    std::size_t cells = 0;
    const auto line = end > kLongestLine ? std::nullopt : read_line(head.substr(0, end), cells);
    if (!line || !((*line)[0] >= 0.0 && (*line)[0] <= kWeek)) {
      return 0;
    }
    if (before) {
      const double interval = (*line)[0] - (*before)[0];
      if (interval > 0.0 && interval <= kLongestInterval) {
        gravity.push_back(std::hypot((*line)[4], (*line)[5], (*line)[6]) / interval);
      } else {
        ++odd;
      }
    }
    before = line;
    head.remove_prefix(end + 1);
  }
  if (gravity.size() < kLeastLines || 8 * odd > gravity.size()) {
    return 0;
  }
  const auto middle = gravity.begin() + static_cast<std::ptrdiff_t>(gravity.size() / 2);
  std::nth_element(gravity.begin(), middle, gravity.end());
  return std::abs(*middle / kGravity - 1.0) <= 0.02 ? 90 : 0;
}

class IncrementDecoder {
 public:
  explicit IncrementDecoder(ColumnSink& sink) : sink_(sink) {}

  Status take(std::string_view text_line, std::uint64_t number) {
    std::size_t cells = 0;
    const auto line = read_line(text_line, cells);
    if (cells == 0) {
      return {};
    }
    if (cells != kCells) {
      return text::wrong_cells(number, cells, kCells);
    }
    if (!line || !std::isfinite((*line)[0])) {
      return text::not_a_number(number, text_line);
    }
    if (!before_) {
      before_ = line;
      return {};
    }
    const double interval = (*line)[0] - (*before_)[0];
    batch_.push_back((*line)[0]);
    for (std::size_t i = 1; i < kCells; ++i) {
      const double rate = (*line)[i] / interval;
      batch_.push_back(interval > 0.0 && std::isfinite(rate) ? rate : missing_sample(Missing::Nan, number));
    }
    before_ = line;
    return batch_.size() < kCells * 1024 ? Status{} : flush();
  }
  Status flush() {
    auto status = batch_.empty() ? Status{} : sink_.rows(batch_);
    delivered_ = delivered_ || !batch_.empty();
    batch_.clear();
    return status;
  }
  [[nodiscard]] bool empty() const { return !delivered_; }

 private:
  ColumnSink& sink_;
  std::optional<Line> before_;
  std::vector<double> batch_;
  bool delivered_ = false;
};

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  const ColumnLayout layout{{"time (s)", "gyro_x (rad/s)", "gyro_y (rad/s)", "gyro_z (rad/s)", "acc_x (m/s^2)",
                             "acc_y (m/s^2)", "acc_z (m/s^2)"},
                            true};
  if (auto status = sink.begin(layout); !status) {
    return status;
  }
  IncrementDecoder decoder(sink);
  auto status =
      text::for_each_row(source, kLongestLine, control, sink,
                         [&](std::string_view line, std::uint64_t number) { return decoder.take(line, number); });
  status = status ? decoder.flush() : status;
  if (!status) {
    return status;
  }
  if (decoder.empty()) {
    return fail(ErrorCode::NoSamples, "The text of increments holds no interval.");
  }
  sink.note("Increments of angle and velocity are read as mean rates over the time between their stamps.");
  return {};
}

}  // namespace

const Format kKfGins{"kf_gins", "IMU text of KF-GINS: seconds of the week, increments of angle and velocity", sniff,
                     decode};

}  // namespace driftlab::formats
