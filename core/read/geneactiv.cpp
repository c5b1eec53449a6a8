/// GENEActiv .bin: lines of text, a header with the calibration, then pages of 300 samples in hexadecimal digits, each
/// with its time, rate and temperature. Source: Activinsights, "GENEActiv operating instructions", "Decoding .bin
/// files".
///
/// Read are the accelerometer [g], corrected by the gain and offset of the file as its maker prescribes, and the
/// temperature of each page [degC], repeated for its samples; not read are light and button. The time is that of
/// core/read/stamped_blocks.hpp.
#include "core/read/decimal.hpp"
#include "core/read/formats.hpp"
#include "core/read/stamped_blocks.hpp"
#include "core/read/text_lines.hpp"
#include "core/read/text_shape.hpp"

#include <array>
#include <optional>

namespace driftlab::formats {
namespace {

constexpr std::string_view kFirstLine = "Device Identity";
constexpr std::size_t kLongestLine = 8192;
constexpr std::size_t kDigits = 12;  ///< of a sample: three of each axis, three of light and button

std::optional<double> number_in(std::string_view text) {
  const std::string copy(text::trim(text));
  double value = 0.0;
  const bool whole = !copy.empty() && decimal::parse(copy.c_str(), value) == copy.c_str() + copy.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

int digit_value(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

/// Three hexadecimal digits as a signed number; nothing where one is none.
std::optional<double> signed_12_bits(std::string_view digits) {
  int value = 0;
  for (const char c : digits.substr(0, 3)) {
    const int digit = digit_value(c);
    if (digit < 0) {
      return std::nullopt;
    }
    value = 16 * value + digit;
  }
  return value < 2048 ? value : value - 4096;
}

tl::unexpected<Error> bad_line(std::uint64_t number, const std::string& what, ErrorCode code = ErrorCode::NotANumber) {
  const std::string row = std::to_string(number);
  return fail(code, "Line " + row + " of the GENEActiv file " + what + ".", {{"row", row}});
}

class GeneactivDecoder {
 public:
  explicit GeneactivDecoder(ColumnSink& sink) : sink_(sink), pages_(sink, 4) {}

  Status take(std::string_view line, std::uint64_t number);
  Status finish();

 private:
  struct Axis {
    std::optional<double> gain;
    std::optional<double> offset;
  };
  Status take_calibration(std::string_view label, std::string_view value, std::uint64_t number);
  Status take_page_fact(std::string_view label, std::string_view value, std::uint64_t number);
  Status take_samples(std::string_view digits, std::uint64_t number);

  ColumnSink& sink_;
  StampedBlocks pages_;
  std::array<Axis, 3> axes_;
  bool in_page_ = false;
  std::optional<double> start_s_;
  std::optional<double> rate_hz_;
  double temperature_degc_ = 0.0;
  std::optional<std::int64_t> sequence_;
  std::int64_t lost_ = 0;
  bool torn_ = false;
  std::vector<double> values_;
};

Status GeneactivDecoder::take_calibration(std::string_view label, std::string_view value, std::uint64_t number) {
  if (label.size() < 3 || label[0] < 'x' || label[0] > 'z' || label[1] != ' ') {
    return {};
  }
  Axis& axis = axes_[static_cast<std::size_t>(label[0] - 'x')];
  const auto stated = number_in(value);
  const bool gain = label.substr(2) == "gain";
  if (!gain && label.substr(2) != "offset") {
    return {};
  }
  if (!stated || (gain && *stated == 0.0)) {
    return bad_line(number, "states no calibration: " + text::excerpt(value));
  }
  (gain ? axis.gain : axis.offset) = stated;
  return {};
}

Status GeneactivDecoder::take_page_fact(std::string_view label, std::string_view value, std::uint64_t number) {
  if (label == "Page Time") {
    // The last colon stands before the milliseconds.
    std::string date(text::trim(value));
    if (const std::size_t colon = date.rfind(':'); colon != std::string::npos && colon > 16) {
      date[colon] = '.';
    }
    start_s_ = text::seconds_of_date(date);
    return start_s_ ? Status{} : bad_line(number, "states no time: " + text::excerpt(value));
  }
  if (label == "Measurement Frequency") {
    rate_hz_ = number_in(value);
    const bool possible = rate_hz_ && *rate_hz_ >= 0.01 && *rate_hz_ <= 1e6;
    return possible ? Status{} : bad_line(number, "states no rate: " + text::excerpt(value));
  }
  if (label == "Temperature") {
    const auto stated = number_in(value);
    temperature_degc_ = stated.value_or(temperature_degc_);
    return stated ? Status{} : bad_line(number, "states no temperature: " + text::excerpt(value));
  }
  if (label == "Sequence Number") {
    const auto stated = number_in(value);
    if (!stated || std::abs(*stated) > 1e12) {
      return bad_line(number, "states no sequence number: " + text::excerpt(value));
    }
    const auto sequence = static_cast<std::int64_t>(*stated);
    lost_ += sequence_ && sequence > *sequence_ ? sequence - *sequence_ - 1 : 0;
    sequence_ = sequence;
  }
  return {};
}

Status GeneactivDecoder::take_samples(std::string_view digits, std::uint64_t number) {
  if (!start_s_ || !rate_hz_) {
    return bad_line(number, "has samples without a time and a rate before them", ErrorCode::ShapeMismatch);
  }
  std::array<double, 3> gain{};
  std::array<double, 3> offset{};
  for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
    const Axis& stated = axes_[axis];
    if (!stated.gain || !stated.offset) {
      return bad_line(number, "has samples, but the header states no calibration", ErrorCode::ShapeMismatch);
    }
    gain[axis] = *stated.gain;
    offset[axis] = *stated.offset;
  }
  torn_ = torn_ || digits.size() % kDigits != 0;
  values_.clear();
  for (; digits.size() >= kDigits; digits.remove_prefix(kDigits)) {
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
      const auto raw = signed_12_bits(digits.substr(3 * axis));
      if (!raw) {
        return bad_line(number, "has samples that are no hexadecimal digits");
      }
      values_.push_back((*raw * 100.0 - offset[axis]) / gain[axis]);
    }
    values_.push_back(temperature_degc_);
  }
  if (values_.empty()) {
    return {};
  }
  if (pages_.empty()) {
    const ColumnLayout layout{{"time (s)", "acc_x (g)", "acc_y (g)", "acc_z (g)", "temperature (degC)"}, true};
    if (auto status = sink_.begin(layout); !status) {
      return status;
    }
  }
  auto status = pages_.take(*start_s_, 1.0 / *rate_hz_, values_);
  start_s_.reset();
  return status;
}

Status GeneactivDecoder::take(std::string_view line, std::uint64_t number) {
  line = text::trim(line);
  if (line == "Recorded Data") {
    in_page_ = true;
    return {};
  }
  const std::size_t colon = line.find(':');
  if (colon != std::string_view::npos) {
    const std::string_view label = line.substr(0, colon);
    const std::string_view value = line.substr(colon + 1);
    return in_page_ ? take_page_fact(label, value, number) : take_calibration(label, value, number);
  }
  const bool samples = in_page_ && !line.empty() && digit_value(line.front()) >= 0;
  return samples ? take_samples(line, number) : Status{};
}

Status GeneactivDecoder::finish() {
  if (pages_.empty()) {
    return fail(ErrorCode::NoSamples, "The GENEActiv file holds no page of samples.");
  }
  if (lost_ > 0) {
    sink_.note("The numbers of the pages show that " + std::to_string(lost_) + " are missing.");
  }
  if (torn_) {
    sink_.note("A page ends within a sample; that sample is left out.");
  }
  return pages_.finish();
}

int sniff(std::string_view head) { return text::trim(head.substr(0, head.find('\n'))) == kFirstLine ? 100 : 0; }

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  GeneactivDecoder decoder(sink);
  auto status = text::for_each_line(source, kLongestLine, control, [&](std::string_view line, std::uint64_t number) {
    return decoder.take(line, number);
  });
  return status ? decoder.finish() : status;
}

}  // namespace

const Format kGeneactiv{"geneactiv", "GENEActiv .bin", sniff, decode};

}  // namespace driftlab::formats
