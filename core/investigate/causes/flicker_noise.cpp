/// flicker_noise: flicker noise.
#include "core/investigate/causes/causes.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

constexpr SlowKind kKind = SlowKind::Flicker;

bool in_unit(const Evidence& found, UnitAxis& axis) { return add_process(axis, "flicker_noise", found); }

}  // namespace

Cause flicker_noise() {
  return {.name = "flicker_noise",
          .title = "flicker noise",
          .family = Family::Mean,
          .rivals = {"gauss_markov", "random_walk"},
          .needs = "a baseline that does not already hold it",
          .separates = "a longer recording: flicker keeps its floor over decades of averaging time",
          .parameters = {{"B", units::level}},
          .slow = &kKind,
          .lacks = lacks_motion,
          .in_unit = in_unit};
}

}  // namespace driftlab::investigate
