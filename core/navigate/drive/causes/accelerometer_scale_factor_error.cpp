/// accelerometer_scale_factor_error: the accelerometer reads too much of every force. (Down, a scale is a bias: gravity
/// hardly varies.)
#include "core/navigate/drive/causes/cause.hpp"
#include "core/navigate/drive/motion_power.hpp"

namespace driftlab::drive {
namespace {

template <int Axis>
constexpr Knob force_scale(std::string_view parameter, std::string_view title) {
  return {.parameter = parameter,
          .title = title,
          .unit = "%",
          .per_si = 100.0,
          .step = 0.01,
          .most = 0.3,
          .turn = [](FilterOptions& o, double by) { o.errors.accelerometer(Axis, Axis) += by; },
          .value = [](const FilterOptions& o) { return o.errors.accelerometer(Axis, Axis); },
          .told_apart = "grows with acceleration along the axis",
          .systematic = [](const Drive& drive, const FilterOptions& o) { return scale_of_noise(drive, o, 3 + Axis); }};
}

}  // namespace

Cause accelerometer_scale_factor_error() {
  return {.name = "accelerometer_scale_factor_error",
          .words = "scale factors of the accelerometer",
          .knobs = {force_scale<0>("x", "the accelerometer along x reads too much by"),
                    force_scale<1>("y", "the accelerometer along y reads too much by")}};
}

}  // namespace driftlab::drive
