/// vibration_bursts: narrow-band noise about f0 that comes and goes; `amplitude` is its rms while it is there,
/// `fraction` the share of the time (core/investigate/causes/burst_frames.hpp).
#include "core/investigate/causes/burst_frames.hpp"
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/narrow_band.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/signal/turns.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace driftlab::investigate {
namespace {

/// Bursts and the time between them as a renewal process of exponential lengths: of R bursts, the share of the time p
/// has the variance 2 p^2 (1 - p)^2 / R.
Evidence describe(const FullRate& data, const std::vector<std::size_t>& scope, const Burstiness& bursts) {
  // Frames at the ends of a burst are loud in part: of bursts of ten frames a tenth of the loud ones.
  constexpr double kEnds = 0.03;
  const double sd = std::hypot(bursts.amplitude_sd, kEnds * bursts.amplitude);
  const double share = bursts.fraction;
  const double sd_share = share * (1.0 - share) * std::sqrt(2.0 / std::max(1.0, bursts.bursts));
  const auto between = [](double value, double half, double least, double most) {
    return Estimate{value, {std::max(least, value - 1.96 * half), std::min(most, value + 1.96 * half)}};
  };
  Evidence evidence;
  evidence.members = scope;
  evidence.gain = bursts.gain;
  evidence.freedom = 5.0;
  evidence.shape = bursts.centre_hz;
  evidence.parameters = {
      {"amplitude", between(bursts.amplitude, sd, 0.0, 1e300), units::level(data.group->unit)},
      {"frequency_hz", between(bursts.frequency_hz, bursts.frequency_sd, 0.0, 1e300), units::hertz({})},
      {"fraction", between(share, sd_share, 0.0, 1.0), units::one({})}};
  return evidence;
}

std::vector<Evidence> examine(const FullRate& data) {
  // Of a score; the search has its own threshold (core/investigate/search/thresholds.hpp), as high. Chosen, not
  // measured.
  constexpr double kClear = 10.0;
  const auto scopes = scopes_of(data);
  std::vector<Evidence> found;
  for (const auto& scope : scopes) {
    if (data.stopped()) {
      break;
    }
    double tried = 0.0;
    const auto bursts = strongest_bursts(data, scope, tried);
    if (!bursts) {
      continue;
    }
    const double score =
        bursts->gain - choice_penalty(tried) - choice_penalty(static_cast<double>(scopes.size())) - 8.0;
    if (score < 4.0) {
      continue;
    }
    Evidence evidence = describe(data, scope, *bursts);
    evidence.score = score;
    found.push_back(std::move(evidence));
    if (scope.size() == data.members() && score > kClear) {
      break;  // bursts in all recordings are one finding, however unevenly chance deals them out
    }
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
  return burst_values(data, found.members, r, found.shape);
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
  // Of the time in which the vibration runs, in the study that shows it.
  constexpr double kShare = 0.1;
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
      .equation =
          "y = b(t) n(t), n noise in a narrow band about the frequency with amplitude as its rms, b = 1 for a fraction "
          "of the time and 0 else",
      .family = SpectralLine{.examine = examine, .find_again = find_again, .log_gain = log_gain, .values = values_of},
      .rivals = {"periodic_disturbance", "chirped_disturbance", "modulated_disturbance"},
      .needs = "any recording",
      .separates = "an accelerometer beside it, which sees the vibration too",
      .parameters = {{"amplitude", units::level}, {"frequency_hz", units::hertz}, {"fraction", units::one}},
      .inject = inject_effect,
      .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
