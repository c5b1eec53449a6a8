/// turn_on_bias: a bias that differs from recording to recording.
#include "core/investigate/causes/causes.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr SlowKind kKind = SlowKind::Offset;

bool in_unit(const Evidence& found, UnitAxis& axis) {
  axis.bias_sd = std::hypot(axis.bias_sd, found.parameters[0].estimate.value);
  return true;
}

}  // namespace

Cause turn_on_bias() {
  return {.name = "turn_on_bias",
          .title = "a bias that differs from recording to recording",
          .family = Family::Mean,
          .rivals = {"scale_factor_error", "scale_factor_asymmetry", "scale_factor_nonlinearity", "gauss_markov",
                     "axis_misalignment", "g_sensitivity", "lever_arm", "vibration_rectification"},
          .needs = "several recordings",
          .separates = "the same condition several times, switched off in between",
          .parameters = {{"sigma", units::level}},
          .slow = &kKind,
          .lacks = lacks_recordings,
          .in_unit = in_unit};
}

}  // namespace driftlab::investigate
