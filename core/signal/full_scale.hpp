#pragma once
/// The ends of a sensor's range, as far as samples pile up there (core/signal/channel_survey.hpp says when).
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace driftlab {

/// The least number of distinct values at which the extreme values of a channel are taken for the ends of its range.
inline constexpr std::size_t kVaried = 8;

/// How often the extreme value is met, and the one next to it.
struct Extreme {
  double value = 0.0;
  std::size_t count = 0;
  double next = 0.0;
  std::size_t next_count = 0;

  /// `value` in units of which larger is more extreme.
  void take(double value_in, bool first) {
    if (first || value_in > value) {
      if (!first) {
        next = value;
        next_count = count;
      }
      value = value_in;
      count = 1;
    } else if (value_in == value) {
      ++count;
    } else if (next_count == 0 || value_in > next) {
      next = value_in;
      next_count = 1;
    } else if (value_in == next) {
      ++next_count;
    }
  }
  [[nodiscard]] std::size_t saturated(bool varied) const {
    const double magnitude = std::abs(value);
    const bool counter_end = magnitude == 32768.0 || magnitude == 32767.0 || value == 65535.0;
    const bool piled_up = varied && count >= 8 && count >= 5 * next_count;
    return counter_end || piled_up ? count : 0;
  }
};

/// The values at which samples pile up [unit of the file]; nothing for an end that none reaches.
struct Rails {
  std::optional<double> low;
  std::optional<double> high;
};

/// Of the sound samples of a channel. Surveys it again: O(n) time.
[[nodiscard]] Rails find_rails(const std::string& column, std::span<const double> values);

}  // namespace driftlab
