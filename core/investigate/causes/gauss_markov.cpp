/// gauss_markov: one more slow Gauss-Markov process.
#include "core/process/gauss_markov.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/process/random.hpp"
#include "core/process/registry.hpp"

namespace driftlab::investigate {
namespace {

double shown_beta(const Stage& /*stage*/, Random& random) { return 0.2 + 0.3 * random.uniform(); }

}  // namespace

Cause gauss_markov() {
  return {.name = "gauss_markov",
          .title = "one more slow Gauss-Markov process",
          .equation = "dy/dt = −β y + σ √(2β) w(t), w white noise of unit density",
          .family = SlowNoise{&registered<GaussMarkov>()},
          .rivals = {"random_walk", "flicker_noise", "linear_drift", "warm_up_transient", "bias_step", "turn_on_bias"},
          .needs = "a baseline that does not already hold it",
          .separates = "a recording many correlation times long",
          .parameters = {{"sigma", units::level}, {"beta", units::per_hertz_rate}},
          .process = "gauss_markov",
          .lacks = lacks_motion,
          .showing = {.given = true, .shape = shown_beta}};
}

}  // namespace driftlab::investigate
