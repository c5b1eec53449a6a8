/// turn_on_bias: a bias that differs from recording to recording.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/process/constant_offset.hpp"

#include <cmath>

namespace driftlab::investigate {
namespace {

bool in_unit(const Evidence& found, UnitAxis& axis) {
  axis.bias_sd = std::hypot(axis.bias_sd, found.parameters[0].estimate.value);
  return true;
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) { return {0.003 * stage.z * kDegree}; }

}  // namespace

Cause turn_on_bias() {
  return {.name = "turn_on_bias",
          .title = "a bias that differs from recording to recording",
          .equation = "y = b, drawn anew for each recording with standard deviation σ",
          .family = SlowNoise{&constant_offset()},
          .rivals = {"scale_factor_error", "scale_factor_asymmetry", "scale_factor_nonlinearity", "gauss_markov",
                     "axis_misalignment", "g_sensitivity", "lever_arm", "vibration_rectification",
                     "heading_dependent_bias"},
          .needs = "several recordings",
          .separates = "the same condition several times, switched off in between",
          .parameters = {{"sigma", units::level}},
          .lacks = lacks_recordings,
          .in_unit = in_unit,
          .showing = {.scenario = Scenario::Rates, .values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
