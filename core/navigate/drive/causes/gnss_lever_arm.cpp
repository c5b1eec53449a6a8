/// gnss_lever_arm: the antenna does not lie where the document says.
///
/// An arm turns the gyroscope's noise into velocity, C (n x l), and the same noise is in the filter's attitude. The
/// filter takes the two for independent. Where the vehicle rolls and pitches that is nothing beside what it shows of
/// the arm; on a flat road the arm down is read from the noise alone (0.9 +- 0.2 m too high with 0.08 deg/s/sqrt(Hz)
/// and fixes of 2 cm), so that it is not sought there.
#include "core/navigate/drive/causes/cause.hpp"
#include "core/navigate/drive/motion_power.hpp"

namespace driftlab::drive {
namespace {

constexpr double kWindow = 0.1;     ///< [s] over which the filter takes the mean of a turning rate for the arm
constexpr double kOverNoise = 4.0;  ///< roll and pitch rates, mean square, over that of the noise

bool rolls_and_pitches(const Drive& drive, const FilterOptions& options) {
  const MotionPower roll = motion_power(drive, options, 0, kWindow);
  const MotionPower pitch = motion_power(drive, options, 1, kWindow);
  return roll.motion + pitch.motion > kOverNoise * (roll.noise + pitch.noise);
}

template <int Axis>
constexpr Knob antenna_arm(std::string_view parameter, std::string_view title) {
  return {.parameter = parameter,
          .title = title,
          .unit = "m",
          .step = 0.1,
          .most = 20.0,
          .turn = [](FilterOptions& o, double by) { o.lever_arm_m(Axis) += by; },
          .value = [](const FilterOptions& o) { return o.lever_arm_m(Axis); },
          .applies = Axis == 2 ? rolls_and_pitches : nullptr,
          .told_apart = "constant in the body: x and y need turns, z needs slopes",
          .prior_sd = [](const Document& document, const FilterOptions&) { return document.gnss.lever_arm_sd_m; }};
}

}  // namespace

Cause gnss_lever_arm() {
  return {.name = "gnss_lever_arm",
          .words = "the antenna's lever arm",
          .knobs = {antenna_arm<0>("x", "the antenna lies ahead of the unit by"),
                    antenna_arm<1>("y", "the antenna lies to the right of the unit by"),
                    antenna_arm<2>("z", "the antenna lies below the unit by")}};
}

}  // namespace driftlab::drive
