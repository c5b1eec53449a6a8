/// odometer_scale: the odometer reads too much of every speed.
#include "core/navigate/drive/causes/cause.hpp"

namespace driftlab::drive {
namespace {

constexpr double kWornTyres = 0.05;  ///< what nobody knows of a wheel's size

}  // namespace

Cause odometer_scale() {
  return {
      .name = "odometer_scale",
      .words = "the scale of the odometer",
      .knobs = {{.parameter = "S",
                 .title = "the odometer reads too much by",
                 .unit = "%",
                 .per_si = 100.0,
                 .step = 0.005,
                 .most = 0.5,
                 .turn = [](FilterOptions& o, double by) { o.odometer_scale += by; },
                 .value = [](const FilterOptions& o) { return o.odometer_scale; },
                 .applies = [](const Drive&, const FilterOptions& o) { return o.odometer; },
                 .told_apart = "a constant ratio to the speed; slip comes in bursts",
                 .prior_sd = [](const Document&, const FilterOptions& o) { return o.odometer ? kWornTyres : 0.0; }}}};
}

}  // namespace driftlab::drive
