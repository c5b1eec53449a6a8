/// noise_level: the white noise on the road is not that of the model, which was mostly characterised at rest.
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

constexpr std::string_view kLevelApart =
    "what is left when every other cause is set: innovations that are white yet too large";

}  // namespace

Cause noise_level() {
  return {.name = "noise_level",
          .words = "the level of white noise on the road",
          .levels = {{.parameter = "gyroscope",
                      .title = "the white noise of the gyroscope on the road is that of the model times",
                      .factor = &FilterOptions::gyro_noise,
                      .told_apart = kLevelApart},
                     {.parameter = "accelerometer",
                      .title = "the white noise of the accelerometer on the road is that of the model times",
                      .factor = &FilterOptions::force_noise,
                      .told_apart = kLevelApart}}};
}

}  // namespace driftlab::drive
