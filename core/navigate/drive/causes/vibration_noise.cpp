/// vibration_noise: white noise that is large where the unit is shaken and small where it is not (vibration.hpp).
#include "core/navigate/drive/causes/cause.hpp"
#include "core/navigate/drive/vibration_thirds.hpp"
#include "core/signal/significant.hpp"

#include <algorithm>

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

std::string thirds_of_outages(const Drive& drive, const DriveEvaluation& mended) {
  const auto shortest =
      std::min_element(mended.durations.begin(), mended.durations.end(),
                       [](const DurationSummary& a, const DurationSummary& b) { return a.duration_s < b.duration_s; });
  const auto thirds = shortest != mended.durations.end() ? errors_by_vibration(drive, *shortest) : std::nullopt;
  if (!thirds) {
    return "";
  }
  return "Outages of " + significant(thirds->duration_s) + " s err by " + significant(thirds->rms_m[0]) + ", " +
         significant(thirds->rms_m[1]) + " and " + significant(thirds->rms_m[2]) +
         " m rms in the calm, the middle and the shaken third by the power of the gyroscope above 5 Hz (" +
         significant(thirds->power[0]) + ", " + significant(thirds->power[1]) + " and " +
         significant(thirds->power[2]) + " times its mean).";
}

}  // namespace

Cause vibration_noise() {
  return {.name = "vibration_noise",
          .words = "noise that follows the vibration",
          .knobs = {shaken_noise<&FilterOptions::gyro_vibration>(
                        "gyroscope", "of the gyroscope's white noise, what follows the vibration is"),
                    shaken_noise<&FilterOptions::force_vibration>(
                        "accelerometer", "of the accelerometer's white noise, what follows the vibration is")},
          .seen_in_outages = thirds_of_outages};
}

}  // namespace driftlab::drive
