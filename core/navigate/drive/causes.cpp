#include "core/navigate/drive/causes.hpp"

#include "core/signal/angle.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace driftlab::drive {
namespace {

constexpr double kPercent = 100.0;

bool has_velocity(const Drive& drive, const FilterOptions&) {
  return !drive.fixes.empty() && drive.fixes[drive.fixes.size() / 2].velocity_ned_m_s.has_value();
}

bool is_constrained(const Drive&, const FilterOptions& options) { return options.constraint.has_value(); }

bool uses_odometer(const Drive&, const FilterOptions& options) { return options.odometer; }

bool has_lasting_errors(const Drive&, const FilterOptions& options) { return !options.coloured.none(); }

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
  constexpr std::string_view kClockApart =
      "grows with speed along the way; a late position alone is the same thing, since only the difference of the two "
      "clocks shows, and the velocity's own delay is told apart by the fixes alone";
  constexpr std::string_view kVelocityApart =
      "the fixes alone show it: displacement against integrated velocity over change of velocity";
  constexpr std::string_view kArmApart = "constant in the body: x and y need turns, z needs slopes";
  constexpr std::string_view kScaleApart = "grows with the angle turned, with the sign of the turn";
  constexpr std::string_view kForceApart = "grows with acceleration along the axis";
  constexpr std::string_view kCrossApart = "tilt after turns about another axis";
  constexpr std::string_view kShakenApart =
      "outages and innovations by the power of the gyroscope above 5 Hz: a noise level is the same in calm and shaken "
      "stretches";
  constexpr std::string_view kMountingApart =
      "sideways velocity in proportion to speed; the arm to the axle in "
      "proportion to turning";
  static const std::vector<Knob> knobs{
      {"imu_time_offset", "delta_s", "the unit's clock is off by", "s", 1.0, 0.02, 2.0,
       [](FilterOptions& o, double by) { o.imu_offset_s += by; }, nullptr, kClockApart},
      {"gnss_velocity_latency", "delay_s", "velocities of fixes are late by", "s", 1.0, 0.02, 2.0,
       [](FilterOptions& o, double by) { o.velocity_latency_s += by; }, has_velocity, kVelocityApart},
      {"gnss_lever_arm", "x", "the antenna lies ahead of the unit by", "m", 1.0, 0.1, 20.0, turn_arm<0>, nullptr,
       kArmApart},
      {"gnss_lever_arm", "y", "the antenna lies to the right of the unit by", "m", 1.0, 0.1, 20.0, turn_arm<1>, nullptr,
       kArmApart},
      {"gnss_lever_arm", "z", "the antenna lies below the unit by", "m", 1.0, 0.1, 20.0, turn_arm<2>, nullptr,
       kArmApart},
      {"gyro_scale_factor_error", "x", "the gyroscope about x reads too much by", "%", kPercent, 0.005, 0.3,
       turn_gyroscope<0, 0>, nullptr, kScaleApart},
      {"gyro_scale_factor_error", "y", "the gyroscope about y reads too much by", "%", kPercent, 0.005, 0.3,
       turn_gyroscope<1, 1>, nullptr, kScaleApart},
      {"gyro_scale_factor_error", "z", "the gyroscope about z reads too much by", "%", kPercent, 0.005, 0.3,
       turn_gyroscope<2, 2>, nullptr, kScaleApart},
      {"gyro_axis_misalignment", "xz", "the gyroscope about x reads of turns about z", "%", kPercent, 0.005, 0.3,
       turn_gyroscope<0, 2>, nullptr, kCrossApart},
      {"gyro_axis_misalignment", "yz", "the gyroscope about y reads of turns about z", "%", kPercent, 0.005, 0.3,
       turn_gyroscope<1, 2>, nullptr, kCrossApart},
      {"accelerometer_scale_factor_error", "x", "the accelerometer along x reads too much by", "%", kPercent, 0.01, 0.3,
       turn_accelerometer<0>, nullptr, kForceApart},
      {"accelerometer_scale_factor_error", "y", "the accelerometer along y reads too much by", "%", kPercent, 0.01, 0.3,
       turn_accelerometer<1>, nullptr, kForceApart},
      {"mounting_angles", "yaw", "the unit is turned against the vehicle about down by", "deg", 1.0 / kDegree,
       0.5 * kDegree, 0.6, [](FilterOptions& o, double by) { o.constraint->yaw_rad += by; }, is_constrained,
       kMountingApart},
      {"mounting_angles", "pitch", "the unit is turned against the vehicle about right by", "deg", 1.0 / kDegree,
       0.5 * kDegree, 0.6, [](FilterOptions& o, double by) { o.constraint->pitch_rad += by; }, is_constrained,
       kMountingApart},
      {"mounting_angles", "axle", "the axle that does not slip lies ahead of the unit by", "m", 1.0, 0.2, 10.0,
       [](FilterOptions& o, double by) { o.constraint->axle_m += by; }, is_constrained, kMountingApart},
      {"odometer_scale", "S", "the odometer reads too much by", "%", kPercent, 0.005, 0.5,
       [](FilterOptions& o, double by) { o.odometer_scale += by; }, uses_odometer,
       "a constant ratio to the speed; slip comes in bursts"},
      {"initial_heading", "heading", "the heading at the start is too small by", "deg", 1.0 / kDegree, 1.0 * kDegree,
       1.6, [](FilterOptions& o, double by) { o.initial_heading_rad += by; }, nullptr,
       "the first minutes only: it decays with turns, as a mounting that is turned does not"},
      {"gnss_coloured_noise", "sigma", "positions of fixes have lasting errors of", "m", 1.0, 0.02, 20.0,
       [](FilterOptions& o, double by) { o.coloured.sigma_m += by; }, nullptr,
       "the correlation of fixes at rest, and of innovations once their level fits"},
      {"gnss_coloured_noise", "tau_s", "lasting errors of positions last", "s", 1.0, 3.0, 300.0,
       [](FilterOptions& o, double by) { o.coloured.tau_s = std::max(o.coloured.tau_s + by, 0.5); }, has_lasting_errors,
       "the correlation of fixes at rest, and of innovations once their level fits"},
      {"vibration_noise", "gyroscope", "the gyroscope's noise that follows the vibration is the rest times", "1", 1.0,
       0.25, 200.0, [](FilterOptions& o, double by) { o.gyro_vibration += by; }, nullptr, kShakenApart, true},
      {"vibration_noise", "accelerometer", "the accelerometer's noise that follows the vibration is the rest times",
       "1", 1.0, 0.25, 200.0, [](FilterOptions& o, double by) { o.force_vibration += by; }, nullptr, kShakenApart,
       true},
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

std::string_view words_of(std::string_view cause) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kWords{{
      {"sample_clock", "a poll faster than the sensor samples"},
      {"imu_time_offset", "an offset of the unit's clock"},
      {"gnss_velocity_latency", "late velocities of fixes"},
      {"gnss_lever_arm", "the antenna's lever arm"},
      {"gyro_scale_factor_error", "scale factors of the gyroscope"},
      {"gyro_axis_misalignment", "misaligned axes of the gyroscope"},
      {"accelerometer_scale_factor_error", "scale factors of the accelerometer"},
      {"mounting_angles", "how the unit is mounted"},
      {"odometer_scale", "the scale of the odometer"},
      {"wheel_slip", "slips of the odometer's wheel"},
      {"initial_heading", "a wrong heading at the start"},
      {"gnss_coloured_noise", "lasting errors of positions"},
      {"vibration_noise", "noise that follows the vibration"},
      {"noise_level", "the level of white noise on the road"},
  }};
  const auto* const found =
      std::find_if(kWords.begin(), kWords.end(), [&](const auto& pair) { return pair.first == cause; });
  assert(found != kWords.end());
  return found->second;
}

std::string words_of(const Knob& knob) {
  const auto knobs = std::count_if(all_knobs().begin(), all_knobs().end(),
                                   [&](const Knob& other) { return other.cause == knob.cause; });
  const std::string_view parameter = knob.parameter.substr(0, knob.parameter.find('_'));
  return std::string(words_of(knob.cause)) + (knobs > 1 ? " (" + std::string(parameter) + ")" : "");
}

}  // namespace driftlab::drive
