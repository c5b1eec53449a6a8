/// quantization_noise: differenced uniform noise, density Q^2 |1 - exp(-i w)|^2 / dt, in all recordings or in some.
/// Fitted to the spectra beside white and slow noise; where these do not describe the recordings, against a spectrum
/// free in every bin that the recordings outside the scope share.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/added_density.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/study/inputs.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

std::vector<Evidence> examine(const FullRate& data) {
  if (data.colour.band_limited() && data.flat) {
    return {};
  }
  std::vector<Evidence> found;
  const auto scopes = noise_scopes(*data.group, data.given);
  for (const auto& scope : scopes) {
    const AddedDensity added = fit_added_density(data, scope, quantization_shape);
    if (!(added.level > 0.0)) {
      continue;
    }
    double gain = added.gain;
    if (data.repeatability > 1.0) {  // what another white level explains counts as little as a white level does
      const double level = fit_added_density(data, scope, [](double, double) { return 1.0; }).gain;
      gain -= level * (1.0 - 1.0 / data.repeatability);
    }
    Evidence evidence;
    evidence.members = scope;
    evidence.gain = added.gain;
    evidence.score = gain - 1.0 - choice_penalty(static_cast<double>(scopes.size()));
    evidence.shape = added.level;
    evidence.parameters = {
        {"Q",
         {std::sqrt(added.level), {std::sqrt(std::max(0.0, added.interval.low)), std::sqrt(added.interval.high)}},
         units::integral(data.group->unit)}};
    found.push_back(std::move(evidence));
  }
  return found;
}

double log_gain(const FullRate& data, const Evidence& found) {
  return added_density_gain(data, found.members, quantization_shape, found.shape);
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  double last = values[0] * std::sqrt(12.0) * (random.uniform() - 0.5);
  for (double& v : draft.slow) {
    const double next = values[0] * std::sqrt(12.0) * (random.uniform() - 0.5);
    v += (next - last) / draft.recording->dt_s;
    last = next;
  }
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  return {std::sqrt(stage.z * std::sqrt(1.0 / stage.samples())) * stage.white_sd() * stage.dt_s()};
}

}  // namespace

Cause quantization_noise() {
  return {.name = "quantization_noise",
          .title = "quantisation noise of an integrated output",
          .equation = "y(k) = (u(k) − u(k−1)) / Δt, u uniform and independent with standard deviation Q",
          .family = DifferencedNoise{.examine = examine, .log_gain = log_gain},
          .rivals = {"white_noise_level"},
          .needs = "any recording; with an automatic baseline recordings of several conditions",
          .separates = "a recording at a higher rate",
          .parameters = {{"Q", units::integral}},
          .process = "quantization_noise",
          .lacks = lacks_contrast,
          .inject = inject_effect,
          .showing = {.given = true, .values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
