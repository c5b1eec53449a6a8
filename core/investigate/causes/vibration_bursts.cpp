/// vibration_bursts: narrow-band noise about f0 that comes and goes; `amplitude` is its rms while it is there,
/// `fraction` the share of the time (core/investigate/causes/burst_frames.hpp).
#include "core/investigate/causes/burst_frames.hpp"
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/narrow_band.hpp"
#include "core/investigate/causes/units.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace driftlab::investigate {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

Evidence describe(const FullRate& data, const std::vector<std::size_t>& scope, const Burstiness& bursts) {
  const double noise = data.innovation_sd * data.innovation_sd;
  // In a burst the band holds rho - 1 times its noise more: of the innovations' power the band is a share.
  const double share = 2.0 * bursts.width_hz * data.dt_s;
  const double square = noise * bursts.scale * share * (bursts.ratio - 1.0);
  const double amplitude = std::sqrt(std::max(0.0, square));
  const double loud = std::max(1.0, bursts.fraction * bursts.frames);
  // A frame in a burst tells the power to 1/sqrt(ordinates); bursts last several frames.
  const double sd = 0.5 * amplitude * std::sqrt(4.0 / loud) * (1.0 + 1.0 / std::sqrt(bursts.ordinates));
  const double sd_share = std::sqrt(8.0 * bursts.fraction * (1.0 - bursts.fraction) / std::max(1.0, bursts.frames));
  const double sd_f = 0.25 * bursts.width_hz;
  Evidence evidence;
  evidence.members = scope;
  evidence.gain = bursts.gain;
  evidence.freedom = 4.0;
  evidence.shape = bursts.centre_hz;
  evidence.parameters = {
      {"amplitude",
       {amplitude, {std::max(0.0, amplitude - 1.96 * sd), amplitude + 1.96 * sd}},
       units::level(data.group->unit)},
      {"frequency_hz",
       {bursts.centre_hz, {bursts.centre_hz - 2.0 * sd_f, bursts.centre_hz + 2.0 * sd_f}},
       units::hertz({})},
      {"fraction",
       {bursts.fraction,
        {std::max(0.0, bursts.fraction - 1.96 * sd_share), std::min(1.0, bursts.fraction + 1.96 * sd_share)}},
       units::one({})}};
  return evidence;
}

std::vector<Evidence> examine(const FullRate& data) {
  const auto scopes = scopes_of(data);
  std::vector<Evidence> found;
  for (const auto& scope : scopes) {
    double tried = 0.0;
    const auto bursts = strongest_bursts(data, scope, tried);
    if (!bursts) {
      continue;
    }
    const double score =
        bursts->gain - choice_penalty(tried) - choice_penalty(static_cast<double>(scopes.size())) - 6.0;
    if (score < 4.0) {
      continue;
    }
    Evidence evidence = describe(data, scope, *bursts);
    evidence.score = score;
    found.push_back(std::move(evidence));
  }
  return found;
}

Evidence find_again(const FullRate& part, const Evidence& found) {
  return describe(part, found.members, bursts_near(part, found.members, found.shape));
}

double log_gain(const FullRate& data, const Evidence& found) {
  const double amplitude = found.parameters[0].estimate.value;
  return burst_gain(data, found.members, found.shape, amplitude, found.parameters[2].estimate.value);
}

std::vector<double> values_of(const FullRate& data, std::size_t r, const Evidence& found) {
  return burst_values(data, r, found.shape, found.parameters[0].estimate.value, found.parameters[2].estimate.value);
}

/// A resonator driven by white noise while a burst of 5 to 20 s lasts.
void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  const double dt = draft.recording->dt_s;
  const double damping = std::exp(-std::numbers::pi * 0.5 * dt);  // half a hertz wide
  const double turn = kTurn * values[1] * dt;
  const double start = values[2] / (12.5 * (1.0 - values[2]));  // bursts per second of rest
  double left_s = 0.0;
  std::complex<double> state = 0.0;
  for (double& mean : draft.mean) {
    if (left_s <= 0.0 && random.uniform() < start * dt) {
      left_s = 5.0 + 15.0 * random.uniform();
    }
    state = state * std::polar(damping, turn) +
            std::sqrt(1.0 - damping * damping) * std::complex<double>(random.normal(), random.normal());
    mean += left_s > 0.0 ? values[0] * state.real() : 0.0;
    left_s -= dt;
  }
}

/// z^2 = sum over the frames of 2 (r - 1 - ln r) of the band's ordinates.
std::vector<double> shown_values(const Stage& stage, Random& random) {
  constexpr double kShare = 0.15;
  const double ordinates = kShare * stage.samples() * stage.dt_s();  // half a hertz of two sides
  const double frequency = 0.25 * stage.rate_hz * (0.8 + 0.6 * random.uniform());
  double low = 1.0;
  double high = 1e6;
  for (int i = 0; i < 80; ++i) {
    const double middle = std::sqrt(low * high);
    (ordinates * (middle - 1.0 - std::log(middle)) < stage.z * stage.z ? low : high) = middle;
  }
  return {stage.white_sd() * std::sqrt((low - 1.0) * 2.0 * 0.8 * stage.dt_s()), frequency, kShare};
}

}  // namespace

Cause vibration_bursts() {
  return {
      .name = "vibration_bursts",
      .title = "vibration in a narrow band that comes and goes",
      .family = SpectralLine{.examine = examine, .find_again = find_again, .log_gain = log_gain, .values = values_of},
      .rivals = {"periodic_disturbance", "chirped_disturbance", "modulated_disturbance"},
      .needs = "any recording",
      .separates = "an accelerometer beside it, which sees the vibration too",
      .parameters = {{"amplitude", units::level}, {"frequency_hz", units::hertz}, {"fraction", units::one}},
      .inject = inject_effect,
      .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
