#pragma once
/// The time column of a text file that has none but states its rate. Internal to core/read.
#include "core/signal/recording.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace driftlab {

/// Time [s] of row i: i/rate, or where the file numbers its packets (`Counter`, `PacketCounter`), (counter -
/// first)/rate, so that lost packets show as gaps. A counter of 16 bits that wraps is continued.
class TimeFromRate {
 public:
  static constexpr std::string_view kName = "time (s)";

  TimeFromRate() = default;
  /// Not needed where one of `names` is a time by its name.
  TimeFromRate(const ColumnNames& names, double rate_hz);

  [[nodiscard]] bool needed() const { return needed_; }
  /// Time of the row whose cells are `row`; rows in order from 0.
  [[nodiscard]] double at(std::uint64_t index, const double* row);
  /// What was made, or why not, for people.
  [[nodiscard]] std::string sentence() const;

 private:
  bool needed_ = false;
  double rate_hz_ = 0.0;
  std::optional<std::size_t> counter_;
  std::string counter_name_;
  double first_ = std::numeric_limits<double>::quiet_NaN();
  double last_ = 0.0;
  double wraps_ = 0.0;
};

}  // namespace driftlab
