/// reference_time_offset: measured follows w(t - delta), to first order -delta w'(t).
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& group, double /*shape*/,
           std::vector<std::vector<double>>& columns) {
  return follow_slope(recording, group, columns, [](double /*t*/, double a) { return -a; });
}

}  // namespace

Cause reference_time_offset() {
  return {.name = "reference_time_offset",
          .title = "a reference that is shifted in time",
          .equation = "x(t) = ω(t − δ), x the reading and ω the reference",
          .family = MeanEffect{.build = build, .penalty = 1.0},
          .rivals = {"reference_clock_drift", "scale_factor_error"},
          .needs = "a profile with a reference column",
          .separates = "the same motion early and late in a long recording",
          .parameters = {{"delta_s", units::seconds}},
          .concern = Concern::Recording,
          .lacks = lacks_profile,
          .showing = {.scenario = Scenario::Profile}};
}

}  // namespace driftlab::investigate
