/// outliers: a fraction of the samples has a gross error of +-magnitude added, its sign at random.
/// Innovations are a mixture (1 - p) N(0, c) + p/2 [N(m, c) + N(-m, c)].
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/fullrate/tails.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

std::vector<Evidence> examine(const FullRate& data) {
  const InnovationHistogram histogram = histogram_of(data, !data.given);
  MixtureFit fit = fit_mixture(histogram, data.given);
  if (!(fit.fraction > 0.0)) {
    return {};
  }
  if (data.given) {
    fit.gain_free_scale = fit_mixture(histogram_of(data, true), false).gain;
  }
  Evidence evidence;
  evidence.members = all_members(*data.group);
  evidence.gain = fit.gain;
  evidence.freedom = 2.0;
  evidence.score = std::min(fit.gain, fit.gain_free_scale + 4.0) - 5.0;
  if (fit.gain_free_scale < 12.0) {
    evidence.score = std::min(evidence.score, 0.0);
  }
  // A crowd of small "outliers" is a broad shoulder, not gross errors.
  if (fit.fraction > 0.02 || fit.magnitude < 2.5) {
    evidence.score = std::min(evidence.score, 0.0);
  }
  const double sd = data.innovation_sd;
  evidence.shape = fit.magnitude;
  evidence.parameters = {{"fraction", {fit.fraction, fit.fraction_interval}, units::one(data.group->unit)},
                         {"magnitude",
                          {fit.magnitude * sd, {fit.magnitude_interval.low * sd, fit.magnitude_interval.high * sd}},
                          units::level(data.group->unit)}};
  return {evidence};
}

double log_gain(const FullRate& data, const Evidence& found) {
  return mixture_gain(histogram_of(data, !data.given), found.parameters[0].estimate.value, found.shape, data.given);
}

std::function<double(double)> tail(const FullRate& /*data*/, const Evidence& found) {
  const double fraction = found.parameters[0].estimate.value;
  const double magnitude = found.shape;
  return [fraction, magnitude](double e) {
    return (1.0 - fraction) * normal_tail(e) +
           0.5 * fraction * (normal_tail(e - magnitude) + normal_tail(e + magnitude));
  };
}

double added_variance(const Evidence& found) {
  const double magnitude = found.parameters[1].estimate.value;
  return found.parameters[0].estimate.value * magnitude * magnitude;
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  for (double& v : draft.mean) {
    if (random.uniform() < values[0]) {
      v += random.uniform() < 0.5 ? values[1] : -values[1];
    }
  }
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  return {0.1 * stage.z * stage.z / stage.samples(), 6.0 * stage.white_sd()};
}

}  // namespace

Cause outliers() {
  return {
      .name = "outliers",
      .title = "gross errors in single samples",
      .equation = "y = e ± magnitude in a fraction of the samples, the sign at random, and y = e else",
      .family = NoiseTails{.examine = examine, .log_gain = log_gain, .tail = tail, .added_variance = added_variance},
      .rivals = {"heavy_tailed_noise"},
      .needs = "any recording",
      .separates = "a longer recording: outliers keep their magnitude, tails go on growing",
      .parameters = {{"fraction", units::one}, {"magnitude", units::level}},
      .inject = inject_effect,
      .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
