#include "core/navigate/drive/quantity.hpp"

#include "core/signal/unit.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace driftlab::drive {
namespace {

constexpr std::array<std::pair<Quantity, std::string_view>, 14> kDriveQuantities{{
    {Quantity::Ignored, "ignored"},
    {Quantity::AngularRate, "angular_rate"},
    {Quantity::SpecificForce, "specific_force"},
    {Quantity::GnssPosition, "gnss_position"},
    {Quantity::GnssVelocity, "gnss_velocity"},
    {Quantity::GnssSpeed, "gnss_speed"},
    {Quantity::GnssCourse, "gnss_course"},
    {Quantity::GnssAccuracy, "gnss_accuracy"},
    {Quantity::FixType, "fix_type"},
    {Quantity::Satellites, "satellites"},
    {Quantity::ReferencePosition, "reference_position"},
    {Quantity::ReferenceVelocity, "reference_velocity"},
    {Quantity::OdometerSpeed, "odometer_speed"},
    {Quantity::OdometerTicks, "odometer_ticks"},
}};

/// What the quantity is measured in along an axis.
Dimension dimension_of(Quantity quantity, std::string_view axis) {
  switch (quantity) {
    case Quantity::AngularRate:
      return Dimension::AngularRate;
    case Quantity::SpecificForce:
      return Dimension::SpecificForce;
    case Quantity::GnssPosition:
    case Quantity::ReferencePosition:
      return axis == "lat" || axis == "lon" ? Dimension::Angle : Dimension::Length;
    case Quantity::GnssVelocity:
    case Quantity::ReferenceVelocity:
    case Quantity::GnssSpeed:
    case Quantity::OdometerSpeed:
      return Dimension::Velocity;
    case Quantity::GnssCourse:
      return Dimension::Angle;
    case Quantity::GnssAccuracy:
      return axis == "speed" ? Dimension::Velocity : Dimension::Length;
    default:
      return Dimension::One;
  }
}

}  // namespace

std::string_view name_of(Quantity quantity) {
  const auto* const found = std::find_if(kDriveQuantities.begin(), kDriveQuantities.end(),
                                         [&](const auto& entry) { return entry.first == quantity; });
  return found->second;
}

Result<Quantity> parse_quantity(std::string_view name) {
  std::string known;
  for (const auto& [quantity, text] : kDriveQuantities) {
    if (text == name) {
      return quantity;
    }
    known.append(known.empty() ? "" : ", ").append(text);
  }
  return fail(ErrorCode::UnknownQuantity,
              "'" + std::string(name) + "' is no quantity of a drive; it is one of " + known + ".",
              {{"quantity", std::string(name)}});
}

const std::vector<std::string_view>& axes_of(Quantity quantity) {
  static const std::vector<std::string_view> none;
  static const std::vector<std::string_view> triad{"x", "y", "z"};
  static const std::vector<std::string_view> position{"lat", "lon", "height", "x", "y", "z"};
  static const std::vector<std::string_view> velocity{"north", "east", "down", "up"};
  static const std::vector<std::string_view> accuracy{"north", "east", "down", "horizontal", "vertical", "speed"};
  switch (quantity) {
    case Quantity::AngularRate:
    case Quantity::SpecificForce:
      return triad;
    case Quantity::GnssPosition:
    case Quantity::ReferencePosition:
      return position;
    case Quantity::GnssVelocity:
    case Quantity::ReferenceVelocity:
      return velocity;
    case Quantity::GnssAccuracy:
      return accuracy;
    default:
      return none;
  }
}

Result<double> factor_of(std::string_view unit, Quantity quantity, std::string_view axis) {
  const Dimension wanted = dimension_of(quantity, axis);
  if (wanted == Dimension::Velocity) {
    if (unit == "km/h") {
      return 1.0 / 3.6;
    }
    if (unit == "knots" || unit == "kn") {
      return 1852.0 / 3600.0;
    }
  }
  auto parsed = parse_unit(unit);
  if (!parsed) {
    return fail(parsed.error());
  }
  if (parsed->dimension != wanted && !(wanted == Dimension::One && parsed->symbol == "1")) {
    return fail(ErrorCode::UnitMismatch,
                "The unit " + std::string(unit) + " does not measure " + std::string(name_of(quantity)) +
                    (axis.empty() ? "." : " " + std::string(axis) + "."),
                {{"unit", std::string(unit)}});
  }
  if (parsed->offset != 0.0) {
    return fail(
        ErrorCode::UnitMismatch,
        "The unit " + std::string(unit) +
            " has an offset, which a drive does not take: its biases are what the filter estimates. Leave it out.",
        {{"unit", std::string(unit)}});
  }
  return parsed->factor;
}

}  // namespace driftlab::drive
