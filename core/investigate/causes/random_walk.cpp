/// random_walk: a random walk of the bias.
#include "core/process/random_walk.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/process/registry.hpp"

namespace driftlab::investigate {
Cause random_walk() {
  return {.name = "random_walk",
          .title = "a random walk of the bias",
          .equation = "dy/dt = K w(t), w white noise of unit density",
          .family = SlowNoise{&registered<RandomWalk>()},
          .rivals = {"gauss_markov", "flicker_noise", "linear_drift", "warm_up_transient", "bias_step"},
          .needs = "a baseline that does not already hold it",
          .separates = "a recording many times longer than the correlation time in question",
          .parameters = {{"K", units::per_root_second}},
          .process = "random_walk",
          .lacks = lacks_motion,
          .showing = {.given = true, .oracle = false}};
}

}  // namespace driftlab::investigate
