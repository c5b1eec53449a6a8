/// scale_factor_asymmetry: S abs(w), w the reference rate about the sensor's own axis.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

#include <cmath>

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& group, double /*shape*/,
           std::vector<std::vector<double>>& columns) {
  return follow_rate(recording, group, columns, [](double w) { return std::fabs(w); });
}

}  // namespace

Cause scale_factor_asymmetry() {
  return {.name = "scale_factor_asymmetry",
          .title = "a scale factor that differs between the signs of the rate",
          .equation = "y = S |ω|, ω the rate about the axis",
          .family = MeanEffect{.build = build, .penalty = 1.0, .part_of_rate = true},
          .rivals = {"scale_factor_error", "scale_factor_nonlinearity", "turn_on_bias"},
          .needs = "rates of both signs",
          .separates = "rates of both signs",
          .parameters = {{"S", units::ppm}},
          .lacks = lacks_rotation,
          .showing = {.scenario = Scenario::Profile}};
}

}  // namespace driftlab::investigate
