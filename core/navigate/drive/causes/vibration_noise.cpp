/// vibration_noise: white noise that is large where the unit is shaken and small where it is not (vibration.hpp).
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

template <double FilterOptions::* Ratio>
constexpr Knob shaken_noise(std::string_view parameter, std::string_view title) {
  return {.parameter = parameter,
          .title = title,
          .unit = "1",
          .step = 0.25,
          .most = 200.0,
          .turn = [](FilterOptions& o, double by) { o.*Ratio += by; },
          .value = [](const FilterOptions& o) { return o.*Ratio; },
          .told_apart =
              "outages and innovations by the power of the gyroscope above 5 Hz: a noise level is the same "
              "in calm and shaken stretches",
          .ratio = true};
}

}  // namespace

Cause vibration_noise() {
  return {.name = "vibration_noise",
          .words = "noise that follows the vibration",
          .knobs = {shaken_noise<&FilterOptions::gyro_vibration>(
                        "gyroscope", "the gyroscope's noise that follows the vibration is the rest times"),
                    shaken_noise<&FilterOptions::force_vibration>(
                        "accelerometer", "the accelerometer's noise that follows the vibration is the rest times")}};
}

}  // namespace driftlab::drive
