#include "core/signal/quantity.hpp"

#include <algorithm>
#include <array>

namespace driftlab {
namespace {

template <std::size_t N>
bool any_of(std::string_view axis, const std::array<std::string_view, N>& axes) {
  return std::find(axes.begin(), axes.end(), axis) != axes.end();
}

}  // namespace

std::string_view name_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::Unspecified:
      return "unspecified";
    case Quantity::Time:
      return "time";
    case Quantity::AngularRate:
      return "angular_rate";
    case Quantity::SpecificForce:
      return "specific_force";
    case Quantity::Temperature:
      return "temperature";
    case Quantity::ReferenceAngularRate:
      return "reference_angular_rate";
    case Quantity::ReferenceSpecificForce:
      return "reference_specific_force";
    case Quantity::ReferenceAngle:
      return "reference_angle";
    case Quantity::MagneticField:
      return "magnetic_field";
    case Quantity::GnssPosition:
      return "gnss_position";
    case Quantity::GnssVelocity:
      return "gnss_velocity";
    case Quantity::ReferencePosition:
      return "reference_position";
    case Quantity::ReferenceVelocity:
      return "reference_velocity";
    case Quantity::ReferenceAttitude:
      return "reference_attitude";
  }
  return "unspecified";
}

const std::vector<Quantity>& all_quantities() {
  static const std::vector<Quantity> all = [] {
    std::vector<Quantity> list;
    for (int i = 0; i <= static_cast<int>(Quantity::ReferenceAttitude); ++i) {
      list.push_back(static_cast<Quantity>(i));
    }
    return list;
  }();
  return all;
}

Result<Quantity> parse_quantity(std::string_view name) {
  std::string known;
  for (const Quantity quantity : all_quantities()) {
    if (name_of(quantity) == name) {
      return quantity;
    }
    known += known.empty() ? "" : ", ";
    known += name_of(quantity);
  }
  return fail(ErrorCode::UnknownQuantity,
              "The quantity '" + std::string(name) + "' is not known; known quantities are " + known + ".",
              {{"quantity", std::string(name)}});
}

bool measures(const Unit& unit, Quantity quantity) {
  if (unit.dimension == Dimension::One) {
    return true;
  }
  switch (quantity) {
    case Quantity::Unspecified:
      return true;
    case Quantity::Time:
      return unit.dimension == Dimension::Time;
    case Quantity::AngularRate:
    case Quantity::ReferenceAngularRate:
      return unit.dimension == Dimension::AngularRate;
    case Quantity::SpecificForce:
    case Quantity::ReferenceSpecificForce:
      return unit.dimension == Dimension::SpecificForce;
    case Quantity::Temperature:
      return unit.dimension == Dimension::Temperature;
    case Quantity::ReferenceAngle:
    case Quantity::ReferenceAttitude:
      return unit.dimension == Dimension::Angle;
    case Quantity::MagneticField:
      return unit.dimension == Dimension::MagneticField;
    case Quantity::GnssPosition:
    case Quantity::ReferencePosition:
      return unit.dimension == Dimension::Length || unit.dimension == Dimension::Angle;
    case Quantity::GnssVelocity:
    case Quantity::ReferenceVelocity:
      return unit.dimension == Dimension::Velocity;
  }
  return false;
}

bool is_sensor(Quantity quantity) {
  return quantity == Quantity::AngularRate || quantity == Quantity::SpecificForce || quantity == Quantity::Unspecified;
}

bool is_axis_of(std::string_view axis, Quantity quantity) {
  using Axes3 = std::array<std::string_view, 3>;
  switch (quantity) {
    case Quantity::Time:
    case Quantity::Temperature:
      return false;
    case Quantity::GnssPosition:
    case Quantity::ReferencePosition:
      return any_of(axis, std::array<std::string_view, 6>{"lat", "lon", "height", "north", "east", "down"});
    case Quantity::GnssVelocity:
    case Quantity::ReferenceVelocity:
      return any_of(axis, Axes3{"north", "east", "down"});
    case Quantity::ReferenceAttitude:
      return any_of(axis, Axes3{"roll", "pitch", "yaw"});
    default:
      return any_of(axis, Axes3{"x", "y", "z"});
  }
}

std::string_view sensor_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::AngularRate:
      return "gyroscope";
    case Quantity::SpecificForce:
      return "accelerometer";
    default:
      return "sensor";
  }
}

Result<Quantity> quantity_of_sensor(std::string_view sensor) {
  for (const Quantity quantity : {Quantity::AngularRate, Quantity::SpecificForce, Quantity::Unspecified}) {
    if (sensor_of(quantity) == sensor) {
      return quantity;
    }
  }
  return fail(ErrorCode::UnknownQuantity,
              "The sensor '" + std::string(sensor) + "' is not known; known are gyroscope, accelerometer and sensor.",
              {{"sensor", std::string(sensor)}});
}

}  // namespace driftlab
