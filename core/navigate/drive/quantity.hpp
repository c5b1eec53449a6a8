#pragma once
/// What a column of a drive's files can hold (spec/drives.md, section 1), beside the quantities of a study.
#include "core/signal/result.hpp"

#include <string_view>
#include <vector>

namespace driftlab::drive {

enum class Quantity {
  Ignored,
  AngularRate,    ///< x, y, z
  SpecificForce,  ///< x, y, z
  GnssPosition,   ///< lat, lon, height, or x, y, z of the Earth-fixed frame
  GnssVelocity,   ///< north, east, down or up
  GnssSpeed,      ///< over ground
  GnssCourse,     ///< from north over east
  GnssAccuracy,   ///< of the position: north, east, down, horizontal, vertical; of the velocity: speed
  FixType,
  Satellites,
  ReferencePosition,  ///< as GnssPosition
  ReferenceVelocity,  ///< as GnssVelocity
  OdometerSpeed,
  OdometerTicks,  ///< counted since the start
};

[[nodiscard]] std::string_view name_of(Quantity quantity);
/// Error: UnknownQuantity, with the names that are known.
[[nodiscard]] Result<Quantity> parse_quantity(std::string_view name);

/// The axis labels that the quantity may carry; an empty list: none.
[[nodiscard]] const std::vector<std::string_view>& axes_of(Quantity quantity);

/// SI units in one `unit` of the quantity: those of studies (core/signal/unit.hpp), km/h, knots and degrees. Errors:
/// UnknownUnit, UnitMismatch.
[[nodiscard]] Result<double> factor_of(std::string_view unit, Quantity quantity, std::string_view axis);

}  // namespace driftlab::drive
