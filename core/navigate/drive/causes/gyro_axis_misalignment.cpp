/// gyro_axis_misalignment: a level axis of the gyroscope reads some of the turns about down.
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

template <int Axis>
constexpr Knob gyro_cross(std::string_view parameter, std::string_view title) {
  return {.parameter = parameter,
          .title = title,
          .unit = "%",
          .per_si = 100.0,
          .step = 0.005,
          .most = 0.3,
          .turn = [](FilterOptions& o, double by) { o.errors.gyroscope(Axis, 2) += by; },
          .value = [](const FilterOptions& o) { return o.errors.gyroscope(Axis, 2); },
          .told_apart = "tilt after turns about another axis"};
}

}  // namespace

Cause gyro_axis_misalignment() {
  return {.name = "gyro_axis_misalignment",
          .words = "misaligned axes of the gyroscope",
          .knobs = {gyro_cross<0>("xz", "the gyroscope about x reads of turns about z"),
                    gyro_cross<1>("yz", "the gyroscope about y reads of turns about z")}};
}

}  // namespace driftlab::drive
