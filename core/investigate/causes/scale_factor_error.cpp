/// scale_factor_error: S w, w the reference rate about the sensor's own axis.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

#include <cmath>

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& group, double /*shape*/,
           std::vector<std::vector<double>>& columns) {
  return follow_rate(recording, group, columns, [](double w) { return w; });
}

bool in_unit(const Evidence& found, UnitAxis& axis) {
  axis.scale_factor = found.parameters[0].estimate.value;
  return true;
}

}  // namespace

Cause scale_factor_error() {
  return {.name = "scale_factor_error",
          .title = "an output that is proportional to the rate (scale-factor error)",
          .equation = "y = S ω, ω the rate about the axis",
          .family = MeanEffect{.build = build, .penalty = 1.0, .part_of_rate = true},
          .rivals = {"scale_factor_asymmetry", "scale_factor_nonlinearity", "turn_on_bias"},
          .needs = "several rates, or a profile",
          .separates = "rates of both signs and several magnitudes; the same rates on another turntable",
          .parameters = {{"S", units::ppm}},
          .lacks = lacks_rotation,
          .in_unit = in_unit,
          .showing = {.scenario = Scenario::Rates}};
}

}  // namespace driftlab::investigate
