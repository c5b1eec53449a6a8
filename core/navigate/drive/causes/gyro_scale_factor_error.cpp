/// gyro_scale_factor_error: the gyroscope reads too much of every turn.
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

template <int Axis>
constexpr Knob gyro_scale(std::string_view parameter, std::string_view title) {
  return {.parameter = parameter,
          .title = title,
          .unit = "%",
          .per_si = 100.0,
          .step = 0.005,
          .most = 0.3,
          .turn = [](FilterOptions& o, double by) { o.errors.gyroscope(Axis, Axis) += by; },
          .value = [](const FilterOptions& o) { return o.errors.gyroscope(Axis, Axis); },
          .told_apart = "grows with the angle turned, with the sign of the turn"};
}

}  // namespace

Cause gyro_scale_factor_error() {
  return {.name = "gyro_scale_factor_error",
          .words = "scale factors of the gyroscope",
          .knobs = {gyro_scale<0>("x", "the gyroscope about x reads too much by"),
                    gyro_scale<1>("y", "the gyroscope about y reads too much by"),
                    gyro_scale<2>("z", "the gyroscope about z reads too much by")}};
}

}  // namespace driftlab::drive
