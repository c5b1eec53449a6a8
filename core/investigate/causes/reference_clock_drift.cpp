/// reference_clock_drift: measured follows w(t (1 + eps)), to first order eps t w'(t).
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& group, double /*shape*/,
           std::vector<std::vector<double>>& columns) {
  return follow_slope(recording, group, columns, [](double t, double a) { return t * a; });
}

}  // namespace

Cause reference_clock_drift() {
  return {.name = "reference_clock_drift",
          .title = "a reference clock that runs at another rate",
          .equation = "x(t) = ω(t (1 + ε)), x the reading and ω the reference",
          .family = MeanEffect{.build = build, .penalty = 1.0},
          .rivals = {"reference_time_offset", "scale_factor_error"},
          .needs = "a profile with a reference column",
          .separates = "the same motion early and late in a long recording",
          .parameters = {{"eps", units::ppm}},
          .concern = Concern::Recording,
          .lacks = lacks_profile,
          .showing = {.scenario = Scenario::Profile}};
}

}  // namespace driftlab::investigate
