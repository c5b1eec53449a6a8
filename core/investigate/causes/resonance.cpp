/// resonance: one more second-order Gauss-Markov process, a broad peak in the spectra of all recordings or of some.
/// E = (white + slow + what is known besides) + sigma^2 D(f; f0, Q), D the density of the process with its aliases
/// (core/process/resonance.hpp). A peak that a level and a slope of the noise around it explain as well is none, nor is
/// one that a single bin shows: that is a line.
#include "core/process/resonance.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/fullrate/peak_spectrum.hpp"
#include "core/process/distributions.hpp"
#include "core/signal/turns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr double kLeastQuality = 2.0;  ///< a hump that is broader is a slope of the noise as well
constexpr std::size_t kFewestBins = 20;
constexpr double kHighest = 0.97;  ///< of the Nyquist frequency
constexpr double kPlaces = 30.0;   ///< peaks of quality 4 that stand side by side in a spectrum

FoundParameter parameter(const char* name, double value, double deviation, const LabUnit& unit) {
  const double factor = std::exp(kNormal975 * std::min(deviation, 5.0));
  return {name, {value, {value / factor, value * factor}}, unit};
}

std::vector<std::vector<std::size_t>> scopes_of_peak(const FullRate& data) {
  std::vector<std::vector<std::size_t>> scopes{all_members(*data.group)};
  const std::vector<std::size_t> moving = moving_members(*data.group);
  if (moving.size() > 1 && moving.size() < data.members()) {
    scopes.push_back(moving);
  }
  for (std::size_t r = 0; data.members() > 1 && r < data.members(); ++r) {
    scopes.push_back({r});
  }
  return scopes;
}

std::optional<Evidence> peak_in(const FullRate& data, const std::vector<std::size_t>& scope, double scopes,
                                PeakGrid& grid) {
  const double nyquist = 0.5 / data.dt_s;
  const double high = kHighest * nyquist;
  const StackedSpectra stacked(data, scope, 0.0, nyquist);
  if (stacked.bins() == 0) {
    return std::nullopt;
  }
  const std::vector<double> expected = stacked.without_peak();
  Peak peak = grid.best(stacked, expected);
  if (peak.f_hz == 0.0) {
    return std::nullopt;
  }
  const double none = stacked.fit(nullptr).log_likelihood;
  const double penalty = 3.0 + choice_penalty(kPlaces) + choice_penalty(scopes);
  if (2.0 * (stacked.fit(&peak).log_likelihood - none) < 0.5 * penalty) {
    return std::nullopt;
  }
  peak = refined(stacked, peak, high);
  const LevelFit fit = stacked.fit(&peak);
  const double variance = fit.level[fit.level.size() - 1];
  if (!(variance > 0.0) || peak.quality < kLeastQuality || peak.quality > 0.95 * kMostQuality ||
      peak.f_hz > 0.999 * high) {
    return std::nullopt;
  }
  Evidence evidence;
  evidence.members = scope;
  evidence.gain = 2.0 * (fit.log_likelihood - none);
  evidence.freedom = 3.0;
  evidence.shape = peak.f_hz;
  // The neighbourhood by itself, whose level and slope are free: what is left of the peak beside other misfit.
  const StackedSpectra near(data, scope, peak.f_hz / 2.5, std::min(nyquist, 2.5 * peak.f_hz));
  const std::vector<double> around = near.without_peak();
  const double local = 2.0 * (near.tilted(around, &peak, peak.f_hz) - near.tilted(around, nullptr, peak.f_hz));
  evidence.score = std::min({evidence.gain, local, evidence.gain - stacked.gain_of_one_bin(expected)}) - penalty;
  const std::array<double, 3> deviation = deviations_of(stacked, peak, variance);
  evidence.parameters = {parameter("sigma", std::sqrt(variance), deviation[0], units::level(data.group->unit)),
                         parameter("frequency_hz", peak.f_hz, deviation[1], units::hertz(data.group->unit)),
                         parameter("quality", peak.quality, deviation[2], units::one(data.group->unit))};
  return evidence;
}

std::vector<Evidence> examine(const FullRate& data) {
  std::vector<Evidence> found;
  const auto seen = std::find_if(data.spectrum.begin(), data.spectrum.end(),
                                 [](const Spectrum& s) { return s.power.size() >= kFewestBins; });
  if (seen == data.spectrum.end()) {
    return found;
  }
  PeakGrid grid(2.0 * seen->f_hz.front(), kHighest * 0.5 / data.dt_s, data.dt_s);
  const auto scopes = scopes_of_peak(data);
  for (const auto& scope : scopes) {
    if (auto evidence = peak_in(data, scope, static_cast<double>(scopes.size()), grid)) {
      found.push_back(*std::move(evidence));
    }
  }
  std::sort(found.begin(), found.end(), [](const Evidence& a, const Evidence& b) { return a.score > b.score; });
  return found;
}

Resonance process_of(const Evidence& found) {
  return {found.parameters[0].estimate.value, found.parameters[1].estimate.value, found.parameters[2].estimate.value};
}

double log_gain(const FullRate& data, const Evidence& found) {
  const StackedSpectra stacked(data, found.members, 0.0, 0.5 / data.dt_s);
  const Resonance process = process_of(found);
  return stacked.with({process.frequency_hz, process.quality}, process.sigma * process.sigma) -
         stacked.fit(nullptr).log_likelihood;
}

double density(const Evidence& found, double f_hz, double dt_s) {
  return process_of(found).spectral_density(f_hz, dt_s).value_or(0.0);  // a resonance has one
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  Resonance{values[0], values[1], values[2]}.add_path(random, draft.recording->dt_s, draft.slow);
}

/// Quality 3 to 12 at a tenth to a third of the rate: the gain is that of z deviations in the bins of its width.
std::vector<double> shown_values(const Stage& stage, Random& random) {
  const double f = stage.rate_hz * (0.1 + 0.23 * random.uniform());
  const double quality = 3.0 + 9.0 * random.uniform();
  const double ordinates = stage.samples() * stage.dt_s() * f / quality;
  const double at_peak = stage.z * 2.5 / std::sqrt(ordinates) * stage.density * stage.density;
  return {std::sqrt(at_peak * 0.5 * kTurn * f / quality), f, quality};
}

}  // namespace

Cause resonance() {
  return {.name = "resonance",
          .title = "a resonance: a second-order Gauss-Markov process",
          .equation =
              "d²y/dt² + (ω₀ / quality) dy/dt + ω₀² y = σ √(2 ω₀³ / quality) w(t), ω₀ = 2π · frequency, w white noise "
              "of unit density",
          .family = SpectralPeak{.examine = examine, .log_gain = log_gain, .density = density},
          .rivals = {"periodic_disturbance", "modulated_disturbance", "band_limited_noise"},
          .needs = "any recording",
          .separates = "another mounting or temperature: a resonance moves, a line does not spread",
          .parameters = {{"sigma", units::level}, {"frequency_hz", units::hertz}, {"quality", units::one}},
          .process = "resonance",
          .inject = inject_effect,
          .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
