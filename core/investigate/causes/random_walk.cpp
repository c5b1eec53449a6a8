/// random_walk: a random walk of the bias.
#include "core/investigate/causes/causes.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

constexpr SlowKind kKind = SlowKind::RandomWalk;

bool in_unit(const Evidence& found, UnitAxis& axis) { return add_process(axis, "random_walk", found); }

}  // namespace

Cause random_walk() {
  return {.name = "random_walk",
          .title = "a random walk of the bias",
          .family = Family::Mean,
          .rivals = {"gauss_markov", "flicker_noise", "linear_drift", "warm_up_transient", "bias_step"},
          .needs = "a baseline that does not already hold it",
          .separates = "a recording many times longer than the correlation time in question",
          .parameters = {{"K", units::per_root_second}},
          .slow = &kKind,
          .lacks = lacks_motion,
          .in_unit = in_unit};
}

}  // namespace driftlab::investigate
