#include "core/navigate/drive/causes.hpp"

#include "core/signal/angle.hpp"

namespace driftlab::drive {
namespace {

constexpr double kPercent = 100.0;

bool has_velocity(const Drive& drive, const FilterOptions&) {
  return !drive.fixes.empty() && drive.fixes[drive.fixes.size() / 2].velocity_ned_m_s.has_value();
}

bool is_constrained(const Drive&, const FilterOptions& options) { return options.constraint.has_value(); }

bool uses_odometer(const Drive&, const FilterOptions& options) { return options.odometer; }

template <int Row, int Column>
void turn_gyroscope(FilterOptions& options, double by) {
  options.errors.gyroscope(Row, Column) += by;
}

template <int Axis>
void turn_accelerometer(FilterOptions& options, double by) {
  options.errors.accelerometer(Axis, Axis) += by;
}

template <int Axis>
void turn_arm(FilterOptions& options, double by) {
  options.lever_arm_m(Axis) += by;
}

}  // namespace

const std::vector<Knob>& all_knobs() {
  constexpr std::string_view clock_apart =
      "grows with speed along the way; a late position alone is the same thing, since only the difference of the two "
      "clocks shows, and the velocity's own delay is told apart by the fixes alone";
  constexpr std::string_view velocity_apart =
      "the fixes alone show it: displacement against integrated velocity over change of velocity";
  constexpr std::string_view arm_apart = "constant in the body: x and y need turns, z needs slopes";
  constexpr std::string_view scale_apart = "grows with the angle turned, with the sign of the turn";
  constexpr std::string_view force_apart = "grows with acceleration along the axis";
  constexpr std::string_view cross_apart = "tilt after turns about another axis";
  constexpr std::string_view mounting_apart =
      "sideways velocity in proportion to speed; the arm to the axle in "
      "proportion to turning";
  static const std::vector<Knob> knobs{
      {"imu_time_offset", "delta_s", "the unit's clock is off by", "s", 1.0, 0.02, 2.0,
       [](FilterOptions& o, double by) { o.imu_offset_s += by; }, nullptr, clock_apart},
      {"gnss_velocity_latency", "delay_s", "velocities of fixes are late by", "s", 1.0, 0.02, 2.0,
       [](FilterOptions& o, double by) { o.velocity_latency_s += by; }, has_velocity, velocity_apart},
      {"gnss_lever_arm", "x", "the antenna lies ahead of the unit by", "m", 1.0, 0.1, 20.0, turn_arm<0>, nullptr,
       arm_apart},
      {"gnss_lever_arm", "y", "the antenna lies to the right of the unit by", "m", 1.0, 0.1, 20.0, turn_arm<1>, nullptr,
       arm_apart},
      {"gnss_lever_arm", "z", "the antenna lies below the unit by", "m", 1.0, 0.1, 20.0, turn_arm<2>, nullptr,
       arm_apart},
      {"gyro_scale_factor_error", "x", "the gyroscope about x reads too much by", "%", kPercent, 0.005, 0.3,
       turn_gyroscope<0, 0>, nullptr, scale_apart},
      {"gyro_scale_factor_error", "y", "the gyroscope about y reads too much by", "%", kPercent, 0.005, 0.3,
       turn_gyroscope<1, 1>, nullptr, scale_apart},
      {"gyro_scale_factor_error", "z", "the gyroscope about z reads too much by", "%", kPercent, 0.005, 0.3,
       turn_gyroscope<2, 2>, nullptr, scale_apart},
      {"gyro_axis_misalignment", "xz", "the gyroscope about x reads of turns about z", "%", kPercent, 0.005, 0.3,
       turn_gyroscope<0, 2>, nullptr, cross_apart},
      {"gyro_axis_misalignment", "yz", "the gyroscope about y reads of turns about z", "%", kPercent, 0.005, 0.3,
       turn_gyroscope<1, 2>, nullptr, cross_apart},
      {"accelerometer_scale_factor_error", "x", "the accelerometer along x reads too much by", "%", kPercent, 0.01, 0.3,
       turn_accelerometer<0>, nullptr, force_apart},
      {"accelerometer_scale_factor_error", "y", "the accelerometer along y reads too much by", "%", kPercent, 0.01, 0.3,
       turn_accelerometer<1>, nullptr, force_apart},
      {"mounting_angles", "yaw", "the unit is turned against the vehicle about down by", "deg", 1.0 / kDegree,
       0.5 * kDegree, 0.6, [](FilterOptions& o, double by) { o.constraint->yaw_rad += by; }, is_constrained,
       mounting_apart},
      {"mounting_angles", "pitch", "the unit is turned against the vehicle about right by", "deg", 1.0 / kDegree,
       0.5 * kDegree, 0.6, [](FilterOptions& o, double by) { o.constraint->pitch_rad += by; }, is_constrained,
       mounting_apart},
      {"mounting_angles", "axle", "the axle that does not slip lies ahead of the unit by", "m", 1.0, 0.2, 10.0,
       [](FilterOptions& o, double by) { o.constraint->axle_m += by; }, is_constrained, mounting_apart},
      {"odometer_scale", "S", "the odometer reads too much by", "%", kPercent, 0.005, 0.5,
       [](FilterOptions& o, double by) { o.odometer_scale += by; }, uses_odometer,
       "a constant ratio to the speed; slip comes in bursts"},
  };
  return knobs;
}

const Knob* find_knob(std::string_view cause, std::string_view parameter) {
  for (const Knob& knob : all_knobs()) {
    if (knob.cause == cause && knob.parameter == parameter) {
      return &knob;
    }
  }
  return nullptr;
}

}  // namespace driftlab::drive
