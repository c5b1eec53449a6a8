/// gyro_axis_misalignment: a level axis of the gyroscope reads some of the turns about down.
#include "core/navigate/drive/causes/gyroscope_error.hpp"

namespace driftlab::drive {

Cause gyro_axis_misalignment() {
  constexpr std::string_view kToldApart = "tilt after turns about another axis";
  return {.name = "gyro_axis_misalignment",
          .words = "misaligned axes of the gyroscope",
          .knobs = {gyroscope_error<0, 2>("xz", "the gyroscope about x reads of turns about z", kToldApart),
                    gyroscope_error<1, 2>("yz", "the gyroscope about y reads of turns about z", kToldApart)}};
}

}  // namespace driftlab::drive
