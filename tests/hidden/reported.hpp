#pragma once
/// What a finding reports, held to what was hidden: in the unit that it writes behind the number, with its sign.
///
/// The units of people are read here by another hand than the one that wrote them, so that a number and its unit cannot
/// be wrong together.
#include "core/investigate/causes/cause.hpp"
#include "tests/hidden/simulated_study.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace driftlab::hidden {

/// A unit as it is written: `deg/sqrt(h)`, `deg/s/(m/s^2)^2`, `s^2/deg`, `ppm`.
struct WrittenUnit {
  double per_si = 1.0;           ///< value in this unit = SI value * per_si
  std::array<double, 4> powers;  ///< of angle, length, time and temperature

  /// Whether both measure the same.
  [[nodiscard]] bool measures_as(const WrittenUnit& other) const;
};

/// Nothing for what is no product, quotient, root or power of rad deg m s h Hz K degC ppm and 1.
[[nodiscard]] std::optional<WrittenUnit> read_unit(std::string_view symbol);

/// The unit of a parameter in tests/hidden/equations.hpp for a channel: `y` is rad/s, or m/s^2.
[[nodiscard]] std::string in_unit_of_channel(std::string_view equation_unit, Quantity quantity);

/// The hidden value of a parameter, as it was hidden; nothing for what was not. Of a cause whose shape decides which
/// parameter its amplitude is, that one alone was hidden.
[[nodiscard]] std::optional<double> hidden_value(const Case& hidden, const investigate::Cause& cause,
                                                 std::string_view parameter);

/// The interval made twice as long on either side: four standard deviations, where it is right. Chance takes the truth
/// out of it once in 11000, out of one of seventy such intervals once in 160. Lengths are those of logarithms where the
/// interval has one sign. Some of these intervals are as long as their value, and a value sixty times too large would
/// bring sixty times the interval with it, which holds the truth on a scale from zero on.
[[nodiscard]] Interval twice_as_long(const Estimate& estimate);

}  // namespace driftlab::hidden
