/// A solution of RTKLIB (`.pos`): comment lines that begin with %, of which the last names the columns, then one
/// position a line, dated `2025/07/08 19:34:18.499` or by GPS week and seconds of the week, between blanks, commas or
/// semicolons. Source: RTKLIB 2.4.2 manual, "Positioning solution file".
///
/// Baselines in east, north and up do not say where they begin, and angles in degrees, minutes and seconds are three
/// cells of one column; both are refused with the option of RTKLIB that writes positions.
///
/// The date becomes the first column, seconds since 1970 on the time scale that the header names (GPST, UTC); the
/// others keep their names, units included.
#include "core/read/formats.hpp"
#include "core/read/text_lines.hpp"
#include "core/read/text_numbers.hpp"
#include "core/signal/missing.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

namespace driftlab::formats {
namespace {

constexpr std::size_t kLongestPosLine = 4096;
constexpr double kGpsEpoch = 315964800.0;  ///< 1980-01-06, seconds since 1970
constexpr double kGpsWeek = 604800.0;

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  constexpr std::string_view kBetween = " \t,;";
  for (std::size_t at = line.find_first_not_of(kBetween); at != std::string_view::npos;
       at = line.find_first_not_of(kBetween, at)) {
    const std::size_t end = std::min(line.find_first_of(kBetween, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = end;
  }
  return words;
}

/// The words of the line that names the columns, the time scale first; nothing for any other line.
std::optional<std::vector<std::string_view>> header_of(std::string_view line) {
  if (!line.starts_with('%')) {
    return std::nullopt;
  }
  auto words = words_of(line.substr(1));
  const bool scale = words.size() > 3 && (words[0] == "GPST" || words[0] == "UTC" || words[0] == "JST");
  const bool place = scale && (words[1].starts_with("latitude") || words[1].starts_with("x-ecef") ||
                               words[1].starts_with("e-baseline"));
  return place ? std::optional(std::move(words)) : std::nullopt;
}

/// Seconds since 1970 of `2025/07/08` `19:34:18.499`, or of a week and its second.
std::optional<double> moment_of(std::string_view first, std::string_view second) {
  const auto week = text::number_of(first);
  const auto within = text::number_of(second);
  if (week && within) {
    return kGpsEpoch + kGpsWeek * *week + *within;
  }
  std::string date(first);
  for (char& c : date) {
    c = c == '/' ? '-' : c;
  }
  return text::seconds_of_date(date + " " + std::string(second));
}

int sniff(std::string_view head) {
  for (std::size_t lines = 0; lines < 200 && head.starts_with('%'); ++lines) {
    const std::size_t end = std::min(head.find('\n'), head.size());
    std::string_view line = head.substr(0, end);
    if (line.ends_with('\r')) {
      line.remove_suffix(1);
    }
    if (header_of(line)) {
      return 95;
    }
    head.remove_prefix(std::min(end + 1, head.size()));
  }
  return 0;
}

class SolutionDecoder {
 public:
  explicit SolutionDecoder(ColumnSink& sink) : sink_(sink) {}

  Status take(std::string_view line, std::uint64_t number) {
    if (const auto header = header_of(line)) {
      return begin(*header);
    }
    const auto words = words_of(line);
    if (line.starts_with('%') || words.empty()) {
      return {};
    }
    if (width_ == 0) {
      return fail(ErrorCode::UnsupportedFormat, "The RTKLIB solution has a position before the names of its columns.");
    }
    if (words.size() != width_ + 1) {
      return text::wrong_cells(number, words.size(), width_ + 1);
    }
    const auto moment = moment_of(words[0], words[1]);
    if (!moment) {
      return text::not_a_number(number, words[0]);
    }
    row_.assign(1, *moment);
    for (std::size_t i = 2; i < words.size(); ++i) {
      const auto value = text::number_of(words[i]);
      if (!value) {
        return text::not_a_number(number, words[i]);
      }
      row_.push_back(std::isfinite(*value) ? *value : missing_sample(Missing::Nan, number));
    }
    batch_.insert(batch_.end(), row_.begin(), row_.end());
    return batch_.size() < width_ * 1024 ? Status{} : flush();
  }

  Status flush() {
    auto status = batch_.empty() ? Status{} : sink_.rows(batch_);
    delivered_ = delivered_ || !batch_.empty();
    batch_.clear();
    return status;
  }
  [[nodiscard]] bool empty() const { return !delivered_; }

 private:
  Status begin(const std::vector<std::string_view>& header) {
    if (width_ > 0) {  // joined files repeat it
      return header.size() == width_ ? Status{}
                                     : fail(ErrorCode::ShapeMismatch, "The RTKLIB solution changes its columns.");
    }
    if (header[1].starts_with("e-baseline")) {
      return fail(ErrorCode::UnsupportedType,
                  "The RTKLIB solution holds baselines, which do not say where they begin; write it with the solution "
                  "format lat/lon/height (out-solformat = llh).");
    }
    if (header[1] == "latitude(d'\")") {
      return fail(ErrorCode::UnsupportedType,
                  "The RTKLIB solution holds angles in degrees, minutes and seconds; write it with the lat/lon format "
                  "ddd.ddddddd (out-degform = deg).");
    }
    width_ = header.size();
    ColumnLayout layout{{"time (s)"}, true};
    for (std::size_t i = 1; i < header.size(); ++i) {
      layout.names.emplace_back(header[i]);
    }
    sink_.note("Times are " + std::string(header[0]) + ", in seconds since 1970.");
    return sink_.begin(layout);
  }

  ColumnSink& sink_;
  std::size_t width_ = 0;
  std::vector<double> row_;
  std::vector<double> batch_;
  bool delivered_ = false;
};

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  SolutionDecoder decoder(sink);
  auto status =
      text::for_each_row(source, kLongestPosLine, control, sink,
                         [&](std::string_view line, std::uint64_t number) { return decoder.take(line, number); });
  status = status ? decoder.flush() : status;
  if (!status) {
    return status;
  }
  return decoder.empty() ? fail(ErrorCode::NoSamples, "The RTKLIB solution holds no position.") : Status{};
}

}  // namespace

const Format kRtklibPos{"rtklib_pos", "solution of RTKLIB (.pos)", sniff, decode};

}  // namespace driftlab::formats
