/// flicker_noise: flicker noise.
#include "core/process/flicker_noise.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/process/registry.hpp"

namespace driftlab::investigate {
Cause flicker_noise() {
  return {.name = "flicker_noise",
          .title = "flicker noise",
          .equation = "S(f) = B² / (2π |f|), S the density of y at frequencies of both signs",
          .family = SlowNoise{&registered<FlickerNoise>()},
          .rivals = {"gauss_markov", "random_walk"},
          .needs = "a baseline that does not already hold it",
          .separates = "a longer recording: flicker keeps its floor over decades of averaging time",
          .parameters = {{"B", units::level}},
          .process = "flicker_noise",
          .lacks = lacks_motion,
          .showing = {.given = true}};
}

}  // namespace driftlab::investigate
