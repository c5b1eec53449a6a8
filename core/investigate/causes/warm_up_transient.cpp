/// warm_up_transient: A exp(-t/tau), t from the first sample of the file.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/process/random.hpp"

#include <cmath>

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& /*group*/, double tau_s,
           std::vector<std::vector<double>>& columns) {
  columns.assign(1, std::vector<double>(recording.length));
  for (std::size_t i = 0; i < recording.length; ++i) {
    columns[0][i] = std::exp(-recording.time_s(i) / tau_s);
  }
  return true;
}

/// From a few seconds to the length of the record, beyond which it is a drift.
std::vector<double> shapes(const ChannelGroup& group) {
  std::vector<double> taus;
  for (double tau = 4.0; tau < 0.8 * longest_s(group); tau *= 1.5) {
    taus.push_back(tau);
  }
  return taus;
}

double shown_tau(const Stage& /*stage*/, Random& random) { return 40.0 + 80.0 * random.uniform(); }

}  // namespace

Cause warm_up_transient() {
  return {.name = "warm_up_transient",
          .title = "a bias that decays exponentially after switching on",
          .equation = "y = amplitude · exp(−t / τ), t from the first sample of the file",
          .family = MeanEffect{.build = build,
                               .shapes = shapes,
                               .refinement = ShapeRefinement::time(),
                               .penalty = 4.0,
                               .scope_moving = true,
                               .scope_single = true},
          .rivals = {"linear_drift", "random_walk", "gauss_markov", "temperature_bias", "bias_step"},
          .needs = "any recording that starts soon after switching on",
          .separates = "switch on again after cooling down: a warm-up repeats, noise does not",
          .parameters = {{"amplitude", units::level}, {"tau_s", units::seconds}},
          .showing = {.shape = shown_tau}};
}

}  // namespace driftlab::investigate
