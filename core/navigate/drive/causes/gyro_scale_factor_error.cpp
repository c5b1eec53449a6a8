/// gyro_scale_factor_error: the gyroscope reads too much of every turn.
#include "core/navigate/drive/causes/gyroscope_error.hpp"

namespace driftlab::drive {

Cause gyro_scale_factor_error() {
  constexpr std::string_view kToldApart = "grows with the angle turned, with the sign of the turn";
  return {.name = "gyro_scale_factor_error",
          .words = "scale factors of the gyroscope",
          .knobs = {gyroscope_error<0, 0>("x", "the gyroscope about x reads too much by", kToldApart),
                    gyroscope_error<1, 1>("y", "the gyroscope about y reads too much by", kToldApart),
                    gyroscope_error<2, 2>("z", "the gyroscope about z reads too much by", kToldApart)}};
}

}  // namespace driftlab::drive
