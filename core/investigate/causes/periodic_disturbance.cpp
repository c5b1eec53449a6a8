/// periodic_disturbance: A sin(2 pi f0 t + phi), amplitude and frequency the same in all recordings of the scope, phase
/// free in each. Found in the periodogram of the innovations, each ordinate against its neighbourhood
/// (core/investigate/causes/lines.hpp).
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/lines.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab::investigate {
namespace {

/// A line that is clear in the whole may be too weak in a part to be found among all frequencies: it is sought where
/// it was found, within what the part resolves.
Evidence find_again(const FullRate& data, const Evidence& found) {
  double longest_s = 0.0;
  for (const std::size_t r : found.members) {
    longest_s = std::max(longest_s, static_cast<double>(data.residual[r].size()) * data.dt_s);
  }
  return line_near(data, found.members, found.shape, 1.0 / longest_s);
}

std::vector<double> values_of(const FullRate& data, std::size_t r, const Evidence& found) {
  return fitted_line(data, r, found.shape);
}

double log_gain(const FullRate& data, const Evidence& found) {
  return line_gain(data, found.members, found.shape, found.parameters[0].estimate.value);
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  const double phase = 2.0 * std::numbers::pi * random.uniform();
  for (std::size_t i = 0; i < draft.mean.size(); ++i) {
    draft.mean[i] += values[0] * std::sin(2.0 * std::numbers::pi * values[1] * draft.recording->time_s(i) + phase);
  }
}

std::vector<double> shown_values(const Stage& stage, Random& random) {
  return {stage.z * stage.white_sd() * std::sqrt(2.0 / stage.samples()), 1.0 + 8.0 * random.uniform()};
}

}  // namespace

Cause periodic_disturbance() {
  return {.name = "periodic_disturbance",
          .title = "a sinusoidal disturbance",
          .equation = "y = amplitude · sin(2π · frequency · t + φ), φ free in each recording",
          .family =
              SpectralLine{.examine = find_lines, .find_again = find_again, .log_gain = log_gain, .values = values_of},
          .rivals = {"once_per_revolution", "gauss_markov"},
          .needs = "any recording",
          .separates = "the same recording with the suspected source switched off",
          .parameters = {{"amplitude", units::level}, {"frequency_hz", units::hertz}},
          .process = "sinusoid",
          .inject = inject_effect,
          .showing = {.values = shown_values}};
}

}  // namespace driftlab::investigate
