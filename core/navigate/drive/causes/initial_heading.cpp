/// initial_heading: the filter begins with a wrong heading.
#include "core/navigate/drive/causes/cause.hpp"
#include "core/signal/angle.hpp"

namespace driftlab::drive {

Cause initial_heading() {
  return {
      .name = "initial_heading",
      .words = "a wrong heading at the start",
      .knobs = {{.parameter = "heading",
                 .title = "the heading at the start is too small by",
                 .unit = "deg",
                 .per_si = 1.0 / kDegree,
                 .step = 1.0 * kDegree,
                 .most = 1.6,
                 .turn = [](FilterOptions& o, double by) { o.initial_heading_rad += by; },
                 .value = [](const FilterOptions& o) { return o.initial_heading_rad; },
                 .told_apart = "the first minutes only: it decays with turns, as a mounting that is turned does not"}}};
}

}  // namespace driftlab::drive
