#pragma once
/// What a column of a recording measures (spec/study.md), and along which axis.
#include "core/signal/result.hpp"
#include "core/signal/unit.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

enum class Quantity {
  Unspecified,  ///< not stated; analysed as it is, in unit `1`
  Time,
  AngularRate,
  SpecificForce,
  Temperature,
  ReferenceAngularRate,
  ReferenceSpecificForce,
  ReferenceAngle,
  MagneticField,
  GnssPosition,
  GnssVelocity,
  ReferencePosition,
  ReferenceVelocity,
  ReferenceAttitude,
};

/// The name used in documents (`angular_rate`, ...).
[[nodiscard]] std::string_view name_of(Quantity quantity);

/// Error: UnknownQuantity, naming what was written and what is known.
[[nodiscard]] Result<Quantity> parse_quantity(std::string_view name);

/// Every quantity once, in declaration order.
[[nodiscard]] const std::vector<Quantity>& all_quantities();

/// True if `unit` can measure `quantity`. Unit `1` measures anything (an unstated unit); positions take lengths or
/// angles.
[[nodiscard]] bool measures(const Unit& unit, Quantity quantity);

/// True for the columns whose errors driftlab characterises: angular rate, specific force, and unspecified columns.
[[nodiscard]] bool is_sensor(Quantity quantity);

/// Axis labels a column of `quantity` may carry: x y z for sensors, lat lon height north east down for positions, ...
[[nodiscard]] bool is_axis_of(std::string_view axis, Quantity quantity);

/// The sensor name of a parameter table: `gyroscope`, `accelerometer`, or `sensor` for an unspecified quantity.
[[nodiscard]] std::string_view sensor_of(Quantity quantity);

/// The quantity behind a sensor name. Error: UnknownQuantity.
[[nodiscard]] Result<Quantity> quantity_of_sensor(std::string_view sensor);

}  // namespace driftlab
