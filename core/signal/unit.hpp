#pragma once
/// Physical units of inputs and outputs. Inside driftlab every number is SI (rad/s, m/s^2, s, rad, m, K).
///
/// A `Unit` is an affine map to SI: si = value * factor + offset. Of those below degC alone has an offset; a unit that
/// is written with a scale and an offset of counts, `degC/340+36.53` (core/signal/written_scale.hpp), has one too.
/// Known symbols (spec/study.md): s ms us ns; deg/s rad/s deg/h; m/s^2 g mg; degC K; deg rad; m; m/s; uT; and `1` for a
/// column whose unit is not stated. g is the standard acceleration 9.80665 m/s^2 (CGPM 1901).
#include "core/signal/result.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// What a unit measures. Two units convert into each other only within one dimension.
enum class Dimension {
  One,
  Time,
  AngularRate,
  SpecificForce,
  Temperature,
  Angle,
  Length,
  Velocity,
  MagneticField,
};

/// Standard acceleration of gravity [m/s^2]; the meaning of the unit symbol `g`.
inline constexpr double kStandardGravity = 9.80665;

struct Unit {
  std::string symbol = "1";
  Dimension dimension = Dimension::One;
  double factor = 1.0;  ///< SI units in one of this unit
  double offset = 0.0;  ///< added after the factor

  [[nodiscard]] double to_si(double value) const { return value * factor + offset; }
  [[nodiscard]] double from_si(double value) const { return (value - offset) / factor; }
  friend bool operator==(const Unit& a, const Unit& b) { return a.symbol == b.symbol; }
};

/// The unit written as `symbol`. Spelling variants users write (`m/s2`, `rad/sec`, `dps`, `°/s`, `degree/s`) are
/// accepted and come back under the canonical symbol; with a scale or an offset the symbol is what was written. Error:
/// UnknownUnit, naming the symbol and the known ones, or what is wrong with the scale and how to write it.
[[nodiscard]] Result<Unit> parse_unit(std::string_view symbol);

/// Every canonical unit, for documentation and tests.
[[nodiscard]] const std::vector<Unit>& all_units();

/// The SI unit of a dimension: `1`, s, rad/s, m/s^2, K, rad, m, m/s, T.
[[nodiscard]] std::string_view si_symbol(Dimension dimension);

/// A unit for an error-model parameter: the unit of the channel times second^`second_power`, in the form engineers use
/// (IEEE Std 952: angle random walk in deg/sqrt(h), bias instability in deg/h, rate random walk in deg/h/sqrt(h)).
/// `second_power_halves` counts half powers of a second, so N (channel unit times sqrt(s)) has +1, K has -1, R has -2,
/// Q has +2, and a level such as B or sigma has 0. `lab = si * factor`.
struct ParameterUnit {
  std::string symbol;
  double per_si = 1.0;  ///< multiply an SI value by this to get the value in `symbol`
};

/// The lab unit of a parameter with dimension (channel dimension)^1 * second^(second_power_halves / 2).
[[nodiscard]] ParameterUnit lab_unit(Dimension channel, int second_power_halves);

}  // namespace driftlab
