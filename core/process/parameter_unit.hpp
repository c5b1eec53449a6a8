#pragma once
/// Units of model parameters as people write them: `deg/sqrt(h)`, `m/s^2`, `deg/s/sqrt(s)`, `1/s`.
#include "core/process/parameter.hpp"
#include "core/signal/quantity.hpp"
#include "core/signal/result.hpp"
#include "core/signal/unit.hpp"

#include <string_view>

namespace driftlab {

/// A product of powers of base units: an SI value is `factor` times the written one. Exponents in halves, so that
/// sqrt(h) is representable.
struct ParameterUnitValue {
  double factor = 1.0;
  int angle = 0;   ///< exponent of rad, doubled
  int length = 0;  ///< exponent of m, doubled
  int second = 0;  ///< exponent of s, doubled
};

/// Grammar: factors joined by `*` and `/` from left to right; a factor is a unit, `1`, `sqrt(unit)` or `unit^n`.
/// Units: rad mrad deg arcsec; m mm; g mg ug (as m/s^2); s ms us min h Hz; ppm. Error: UnknownUnit.
[[nodiscard]] Result<ParameterUnitValue> parse_parameter_unit(std::string_view text);

/// SI units in one of `symbol`, the unit of a parameter of a channel of that dimension, such as deg/sqrt(h),
/// ug/sqrt(Hz), 1/s. Errors: UnknownUnit, UnitMismatch (not of dimension (channel unit)^channel_power
/// s^(second_power_halves/2)).
[[nodiscard]] Result<double> parameter_factor(std::string_view symbol, Dimension channel, const ParameterSpec& spec);

/// Whether a unit is that of a sensor's quantity over s^per_seconds: of an angular rate, or else of a specific force.
/// Of an unspecified quantity every unit is.
[[nodiscard]] bool measures(const ParameterUnitValue& unit, Quantity quantity, int per_seconds);

}  // namespace driftlab
