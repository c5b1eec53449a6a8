/// The log of Sony's CXD5602PWBIMU board: one sample a line, eight words of eight hexadecimal digits between commas, a
/// time in ticks of 19.2 MHz (32 bits, unsigned) and seven float32: temperature [degC], angular rate x y z [rad/s],
/// specific force x y z [m/s^2]. The counter of ticks starts again every 223.7 s; the time delivered goes on.
#include "core/read/formats.hpp"
#include "core/read/text_shape.hpp"
#include "core/signal/missing.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>

namespace driftlab::formats {
namespace {

constexpr std::size_t kWords = 8;
constexpr std::size_t kLineBytes = kWords * 8 + kWords - 1;
constexpr double kTicksPerSecond = 19.2e6;

using Words = std::array<std::uint32_t, kWords>;

std::optional<Words> read_words(std::string_view line) {
  if (line.size() != kLineBytes) {
    return std::nullopt;
  }
  Words words{};
  for (std::size_t i = 0; i < kWords; ++i) {
    const char* const begin = line.data() + 9 * i;
    const auto [end, error] = std::from_chars(begin, begin + 8, words[i], 16);
    if (error != std::errc{} || end != begin + 8 || (i + 1 < kWords && *end != ',')) {
      return std::nullopt;
    }
  }
  return words;
}

int sniff(std::string_view head) {
  return read_words(text::trim(head.substr(0, std::min(head.find('\n'), head.size())))) ? 100 : 0;
}

class LineDecoder {
 public:
  explicit LineDecoder(ColumnSink& sink) : sink_(sink) {}

  Status take(std::string_view line, bool too_long) {
    ++line_;
    line = text::trim(line);
    if (line.empty() && !too_long) {
      return {};
    }
    const auto words = too_long ? std::nullopt : read_words(line);
    if (!words) {
      const std::string row = std::to_string(line_);
      return fail(ErrorCode::RaggedRow, "Line " + row + " is not eight words of eight hexadecimal digits.",
                  {{"row", row}});
    }
    const std::uint32_t ticks = (*words)[0];
    first_ = rows_ == 0 ? static_cast<double>(ticks) : first_;
    wraps_ += rows_ > 0 && ticks < last_ && last_ - ticks > 0x80000000U ? 1 : 0;
    last_ = ticks;
    std::array<double, kWords> row{};
    row[0] = (ticks - first_ + 4294967296.0 * static_cast<double>(wraps_)) / kTicksPerSecond;
    for (std::size_t i = 1; i < kWords; ++i) {
      const double value = std::bit_cast<float>((*words)[i]);
      row[i] =
          std::isfinite(value) ? value : missing_sample(std::isnan(value) ? Missing::Nan : Missing::Infinite, line_);
    }
    ++rows_;
    batch_.insert(batch_.end(), row.begin(), row.end());
    return batch_.size() >= 8192 ? flush() : Status{};
  }
  Status flush() {
    auto status = batch_.empty() ? Status{} : sink_.rows(batch_);
    batch_.clear();
    return status;
  }
  [[nodiscard]] std::uint64_t wraps() const { return wraps_; }

 private:
  ColumnSink& sink_;
  std::uint64_t line_ = 0;
  std::uint64_t rows_ = 0;
  std::uint64_t wraps_ = 0;
  std::uint32_t last_ = 0;
  double first_ = 0.0;
  std::vector<double> batch_;
};

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  const ColumnLayout layout{{"time (s)", "temperature (degC)", "gyro_x (rad/s)", "gyro_y (rad/s)", "gyro_z (rad/s)",
                             "acc_x (m/s^2)", "acc_y (m/s^2)", "acc_z (m/s^2)"},
                            true};
  if (auto status = sink.begin(layout); !status) {
    return status;
  }
  LineDecoder lines(sink);
  while (!control.stop.stop_requested()) {
    auto view = source.view(256);
    if (!view) {
      return fail(view.error());
    }
    if (view->empty()) {
      if (auto status = lines.flush(); !status) {
        return status;
      }
      if (lines.wraps() > 0) {
        sink.note("The counter of ticks started again " + how_often(lines.wraps()) + "; the time goes on.");
      }
      return {};
    }
    // Lines are short: one without its end within 256 bytes is none of ours, and fails as such.
    const std::size_t end = std::min(view->find('\n'), view->size());
    if (auto status = lines.take(view->substr(0, std::min<std::size_t>(end, 256)), end >= 256); !status) {
      return status;
    }
    source.consume(std::min(end + 1, view->size()));
  }
  return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
}

}  // namespace

const Format kCxd5602{"cxd5602", "log of a CXD5602PWBIMU board in hexadecimal words", sniff, decode};

}  // namespace driftlab::formats
