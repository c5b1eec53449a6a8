/// vibration_noise: white noise that is large where the unit is shaken and small where it is not (vibration.hpp).
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

template <double FilterOptions::* Share>
constexpr Knob shaken_noise(std::string_view parameter, std::string_view title) {
  return {.parameter = parameter,
          .title = title,
          .unit = "%",
          .per_si = 100.0,
          .step = 0.1,
          .most = kMostShaken,
          .turn = [](FilterOptions& o, double by) { o.*Share += by; },
          .value = [](const FilterOptions& o) { return o.*Share; },
          .told_apart =
              "outages and innovations by the power of the gyroscope above 5 Hz: a noise level is the same "
              "in calm and shaken stretches",
          .share = true};
}

}  // namespace

Cause vibration_noise() {
  return {.name = "vibration_noise",
          .words = "noise that follows the vibration",
          .knobs = {shaken_noise<&FilterOptions::gyro_vibration>(
                        "gyroscope", "of the gyroscope's white noise, what follows the vibration is"),
                    shaken_noise<&FilterOptions::force_vibration>(
                        "accelerometer", "of the accelerometer's white noise, what follows the vibration is")}};
}

}  // namespace driftlab::drive
