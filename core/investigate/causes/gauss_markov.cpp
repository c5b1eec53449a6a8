/// gauss_markov: one more slow Gauss-Markov process.
#include "core/investigate/causes/causes.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

constexpr SlowKind kKind = SlowKind::GaussMarkov;

bool in_unit(const Evidence& found, UnitAxis& axis) { return add_process(axis, "gauss_markov", found); }

}  // namespace

Cause gauss_markov() {
  return {.name = "gauss_markov",
          .title = "one more slow Gauss-Markov process",
          .family = Family::Mean,
          .rivals = {"random_walk", "flicker_noise", "linear_drift", "warm_up_transient", "bias_step", "turn_on_bias"},
          .needs = "a baseline that does not already hold it",
          .separates = "a recording many correlation times long",
          .parameters = {{"sigma", units::level}, {"beta", units::per_hertz_rate}},
          .slow = &kKind,
          .lacks = lacks_motion,
          .in_unit = in_unit};
}

}  // namespace driftlab::investigate
