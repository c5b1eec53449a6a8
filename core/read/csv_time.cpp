#include "core/read/csv_time.hpp"

#include "core/signal/infer_role.hpp"
#include "core/signal/missing.hpp"
#include "core/signal/number.hpp"
#include "core/signal/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab {
namespace {

bool is_counter(std::string_view name) {
  std::string letters;
  for (const char c : lower_case(name)) {
    letters += c >= 'a' && c <= 'z' ? std::string(1, c) : std::string();
  }
  constexpr std::array<std::string_view, 4> kNames{"counter", "packetcounter", "samplecounter", "packetcount"};
  return std::find(kNames.begin(), kNames.end(), letters) != kNames.end();
}

}  // namespace

TimeFromRate::TimeFromRate(const ColumnNames& names, double rate_hz) : needed_(true), rate_hz_(rate_hz) {
  const std::vector<ColumnRole> roles = infer_roles(names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    needed_ = needed_ && roles[i].quantity != Quantity::Time;
    if (!counter_ && is_counter(names[i])) {
      counter_ = i;
      counter_name_ = names[i];
    }
  }
}

double TimeFromRate::at(std::uint64_t index, const double* row) {
  if (!counter_) {
    return static_cast<double>(index) / rate_hz_;
  }
  const double count = row[*counter_];
  if (std::isnan(count)) {
    return missing_sample(Missing::Empty, index + 1);
  }
  constexpr double kLargest = 0x1p53;  // beyond it a double does not count by one
  if (std::abs(count) > kLargest) {
    return missing_sample(Missing::OutOfRange, index + 1);
  }
  constexpr double kWrap = 65536.0;
  const bool started = !std::isnan(first_);
  first_ = started ? first_ : count;
  wraps_ += started && count < last_ - 0.5 * kWrap ? kWrap : 0.0;
  last_ = count;
  return (count - first_ + wraps_) / rate_hz_;
}

std::string TimeFromRate::sentence() const {
  const std::string rate = "The file states " + to_text(rate_hz_) + " Hz";
  if (!needed_) {
    return rate + " beside its time column; the time column rules.";
  }
  return rate + (counter_ ? " and numbers its rows in '" + counter_name_ + "'; the column '" : "; the column '") +
         std::string(kName) + "' is made from that.";
}

}  // namespace driftlab
