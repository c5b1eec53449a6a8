/// heavy_tailed_noise: the white part is Student-t with nu degrees of freedom and its variance unchanged.
/// The innovations' nu_e follows by maximum likelihood; kurtosis passes to the white part as the square of its share of
/// the variance: 6/(nu - 4) = 6/(nu_e - 4) / rho^2.
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
  TailFit fit = fit_student(histogram, data.given);
  if (!(fit.value > 0.0)) {
    return {};
  }
  if (data.given) {
    fit.gain_free_scale = fit_student(histogram_of(data, true), false).gain;
  }
  Evidence evidence;
  evidence.members = all_members(*data.group);
  evidence.gain = fit.gain;
  evidence.freedom = 1.0;
  evidence.score = std::min(fit.gain, fit.gain_free_scale + 3.0) - 2.0;
  if (fit.gain_free_scale < 9.0) {
    evidence.score = std::min(evidence.score, 0.0);
  }
  const double square = data.white_share * data.white_share;
  const auto of_white = [&](double inverse_nu) {  // 1/nu_e -> nu of the white part
    const double excess = 6.0 * inverse_nu / std::max(1e-9, 1.0 - 4.0 * inverse_nu) / square;
    return inverse_nu < 0.24 ? 4.0 + 6.0 / excess : 1.0 / inverse_nu;
  };
  evidence.shape = fit.value;
  evidence.parameters = {
      {"nu",
       {of_white(fit.value), {of_white(fit.interval.high), of_white(std::max(1e-6, fit.interval.low))}},
       units::one(data.group->unit)}};
  return {evidence};
}

double log_gain(const FullRate& data, const Evidence& found) {
  return student_gain(histogram_of(data, !data.given), found.shape, data.given);
}

/// The scale by the median of |e|, which no tail moves.
std::function<double(double)> tail(const FullRate& data, const Evidence& found) {
  std::vector<double> modulus;
  std::size_t samples = 0;
  for (const Series& e : data.innovation) {
    samples += e.size();
  }
  modulus.reserve(samples);
  for (std::size_t r = 0; r < data.members(); ++r) {
    for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
      if (data.used[r][i] != 0) {
        modulus.push_back(std::fabs(data.innovation[r][i]));
      }
    }
  }
  const auto middle = modulus.begin() + static_cast<std::ptrdiff_t>(modulus.size() / 2);
  std::nth_element(modulus.begin(), middle, modulus.end());
  const double nu = 1.0 / found.shape;
  const double scale = *middle / student_quantile(0.75, nu);
  return [nu, scale](double e) { return student_tail(e / scale, nu); };
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  double square = 0.0;
  for (const double v : draft.white) {
    square += v * v / static_cast<double>(draft.white.size());
  }
  const double scale = std::sqrt(square * (values[0] - 2.0) / values[0]);
  for (double& v : draft.white) {
    v = scale * random.student(values[0]);
  }
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  return {4.0 + 6.0 / (stage.z * std::sqrt(24.0 / stage.samples()))};
}

}  // namespace

Cause heavy_tailed_noise() {
  return {.name = "heavy_tailed_noise",
          .title = "white noise with heavier tails than a Gaussian",
          .equation =
              "e = s √((ν − 2) / ν) T, T of Student's distribution with ν degrees of freedom, s the standard deviation "
              "of the white part",
          .family = NoiseTails{.examine = examine, .log_gain = log_gain, .tail = tail},
          .rivals = {"outliers"},
          .needs = "any recording",
          .separates = "a longer recording: outliers keep their magnitude, tails go on growing",
          .parameters = {{"nu", units::one, 2.3}},
          .inject = inject_effect,
          .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
