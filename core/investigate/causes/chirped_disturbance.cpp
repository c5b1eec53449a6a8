/// chirped_disturbance: a sinusoid whose frequency runs evenly from f0 to f1 over the recording.
///
/// How it is sought is in core/investigate/causes/chirp_search.hpp. Its place costs what there are of distinguishable
/// ones, a frequency in 1/T and a slope in 2/T^2.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/chirp_search.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/narrow_band.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/signal/turns.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace driftlab::investigate {
namespace {

Evidence describe(const FullRate& data, const std::vector<std::size_t>& scope, const Followed& followed) {
  double weight = 0.0;
  double mean = 0.0;
  const double longest = longest_s(data, scope);
  for (const std::size_t r : scope) {
    const PhaseFit fit = fit_phases(data, r, {followed.sweep});
    const double modulus = std::abs(fit.amplitude[0]);
    weight += 1.0 / fit.variance;
    mean += std::sqrt(std::max(0.0, modulus * modulus - fit.variance)) / fit.variance;
  }
  const double amplitude = mean / weight;
  const double sd = 1.0 / std::sqrt(weight);
  // Of a phase a + 2 pi f t + pi c t^2 under white noise: the frequency at either end has the variance 48 / (pi^2 X
  // T^2).
  const double sd_f = std::sqrt(48.0 / std::max(1.0, followed.x)) / (std::numbers::pi * longest);
  const double f1 = followed.sweep.at(longest);
  Evidence evidence;
  evidence.members = scope;
  evidence.gain = followed.x;
  evidence.freedom = 3.0 + static_cast<double>(scope.size());
  evidence.shape = followed.sweep.f_hz;
  const auto hertz = [&](double f) { return Estimate{f, {f - 1.96 * sd_f, f + 1.96 * sd_f}}; };
  evidence.parameters = {{"amplitude",
                          {amplitude, {std::max(0.0, amplitude - 1.96 * sd), amplitude + 1.96 * sd}},
                          units::level(data.group->unit)},
                         {"f0_hz", hertz(followed.sweep.f_hz), units::hertz({})},
                         {"f1_hz", hertz(f1), units::hertz({})}};
  return evidence;
}

std::vector<Evidence> examine(const FullRate& data) {
  const auto scopes = scopes_of(data);
  const auto chirps = chirps_of(data, scopes);
  std::vector<Evidence> found;
  for (std::size_t s = 0; s < scopes.size() && !data.stopped(); ++s) {
    const std::optional<Followed>& chirp = chirps[s];
    if (!chirp) {
      continue;
    }
    // A frequency in 1/T and a slope in 2/T^2.
    const double places = 0.5 * std::pow(0.5 / data.dt_s * longest_s(data, scopes[s]), 2.0);
    const double score = -2.0 * log_tail(chirp->x, static_cast<double>(scopes[s].size())) - choice_penalty(places) -
                         choice_penalty(static_cast<double>(scopes.size())) - 3.0;
    if (score < 4.0) {
      continue;
    }
    Evidence evidence = describe(data, scopes[s], *chirp);
    evidence.score = score;
    found.push_back(std::move(evidence));
  }
  return found;
}

Sweep sweep_of(const Evidence& found, double seconds) {
  const double f0 = found.parameters[1].estimate.value;
  return {f0, (found.parameters[2].estimate.value - f0) / seconds};
}

/// Length of the whole recording of which a part is given.
double whole_length_s(const FullRate& part, std::size_t r) {
  return static_cast<double>(part.group->members[r].recording->count()) * part.dt_s;
}

/// A half of the recording holds the first or the second half of the run.
Evidence find_again(const FullRate& part, const Evidence& found) {
  const double seconds = longest_s(part, found.members);
  double whole = 0.0;
  for (const std::size_t r : found.members) {
    whole = std::max(whole, whole_length_s(part, r));
  }
  const Sweep sweep = sweep_of(found, whole);
  const Followed first = follow_chirp(part, found.members, sweep, 2.0 / seconds);
  const Followed second =
      follow_chirp(part, found.members, {sweep.at(whole - seconds), sweep.slope_hz_s}, 2.0 / seconds);
  return describe(part, found.members, first.x > second.x ? first : second);
}

/// `found` is of the other half, which need not be as long: the run goes on from its end, or came to its beginning.
/// What it says of the frequencies here has an error of its own (the derivative of a second degree's fit, a length away
/// from its middle), so that the best sweep within two deviations is taken, less the logarithm of how many there are.
double log_gain(const FullRate& data, const Evidence& found) {
  const double amplitude = found.parameters[0].estimate.value;
  double whole = 0.0;
  for (const std::size_t r : found.members) {
    whole = std::max(whole, whole_length_s(data, r));
  }
  const double here = longest_s(data, found.members);
  const double other = whole - here;
  const Sweep sweep = sweep_of(found, other);
  const double sd_f = std::sqrt(408.0 / std::max(1.0, found.gain)) / (std::numbers::pi * other);
  const double reach = std::clamp(2.0 * sd_f, 2.0 / here, 6.0 / here);
  const double places = std::max(1.0, 2.0 * std::pow(reach * here, 2.0));
  const auto gain_along = [&](const Sweep& expected) {
    const Followed best = follow_chirp(data, found.members, expected, reach);
    double gain = -std::log(places);
    for (const std::size_t r : found.members) {
      const PhaseFit fit = fit_phases(data, r, {best.sweep});
      gain += log_gain_of(fit.amplitude[0], fit.variance, amplitude);
    }
    return gain;
  };
  return std::max(gain_along({sweep.at(other), sweep.slope_hz_s}), gain_along({sweep.at(-here), sweep.slope_hz_s}));
}

std::vector<double> values_of(const FullRate& data, std::size_t r, const Evidence& found) {
  return fit_phases(data, r, {sweep_of(found, longest_s(data, found.members))}).values;
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  const double phase = kTurn * random.uniform();
  const double seconds = draft.recording->time_s(draft.mean.size());
  for (std::size_t i = 0; i < draft.mean.size(); ++i) {
    const double t = draft.recording->time_s(i);
    const double turns = values[1] * t + 0.5 * (values[2] - values[1]) * t * t / seconds;
    draft.mean[i] += values[0] * std::sin(kTurn * turns + phase);
  }
}

std::vector<double> shown_values(const Stage& stage, Random& random) {
  const double amplitude = stage.z * stage.white_sd() * std::sqrt(2.0 / stage.samples());
  return {amplitude, 3.0 + 4.0 * random.uniform(), 12.0 + 6.0 * random.uniform()};
}

}  // namespace

Cause chirped_disturbance() {
  return {
      .name = "chirped_disturbance",
      .title = "a disturbance whose frequency runs",
      .equation = "y = amplitude · sin(2π (f₀ t + (f₁ − f₀) t² / (2T)) + φ), T the length of the recording",
      .family = SpectralLine{.examine = examine, .find_again = find_again, .log_gain = log_gain, .values = values_of},
      .rivals = {"periodic_disturbance"},
      .needs = "any recording",
      .separates = "the same recording with the suspected machine at a constant speed",
      .parameters = {{"amplitude", units::level}, {"f0_hz", units::hertz}, {"f1_hz", units::hertz}},
      .inject = inject_effect,
      .showing = {.values = shown_values}};
}

}  // namespace driftlab::investigate
