/// band_limited_noise: the white noise behind a second-order Butterworth low-pass, its density at low frequency kept.
/// E = N^2 |H|^2 + floor + slow: rounding and the leakage of the periodogram fill the stop band by a level that is
/// fitted.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/fullrate/whittle.hpp"
#include "core/investigate/slow/profile.hpp"
#include "core/investigate/study/measured_constants.hpp"

#include <cmath>
#include <functional>
#include <numbers>

namespace driftlab::investigate {
namespace {

struct Shape {
  double log_likelihood = 0.0;
  double density = 0.0;
  double floor = 0.0;  ///< beyond that of rounding
};

/// Mean of a gain over a bin of the spectrum by Simpson's rule: at a steep edge the middle alone is off by its
/// curvature.
double over_bin(const std::function<double(double)>& gain, double f_hz, double weight) {
  constexpr double kHalf = 0.0125;  // bins are 2.5 % wide
  if (weight < 4.0) {
    return gain(f_hz);
  }
  return (gain(f_hz * (1.0 - kHalf)) + 4.0 * gain(f_hz) + gain(f_hz * (1.0 + kHalf))) / 6.0;
}

/// All recordings under one density N^2 g(f) + floor + slow, g by frequency; N^2 is the baseline's where that is given.
Shape fit_shape(const FullRate& data, const std::function<double(double)>& gain) {
  Eigen::Index bins = 0;
  for (const Spectrum& s : data.spectrum) {
    bins += static_cast<Eigen::Index>(s.power.size());
  }
  LinearDensity density;
  density.power.resize(bins);
  density.weight.resize(bins);
  density.fixed.resize(bins);
  density.shape = Eigen::MatrixXd::Ones(bins, data.given ? 1 : 2);
  const double floor = data.lattice_step * data.lattice_step / 12.0 * data.dt_s + 1e-9 * data.model.white;
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < data.spectrum.size(); ++r) {
    const Spectrum& s = data.spectrum[r];
    for (std::size_t j = 0; j < s.power.size(); ++j, ++row) {
      density.power[row] = s.power[j];
      density.weight[row] = s.weight[j];
      density.fixed[row] = data.slow[r][j] + floor;
      if (data.given) {
        density.fixed[row] += data.model.white * over_bin(gain, s.f_hz[j], s.weight[j]);
      } else {
        density.shape(row, 1) = over_bin(gain, s.f_hz[j], s.weight[j]);
      }
    }
  }
  Eigen::VectorXd start = Eigen::VectorXd::Constant(density.shape.cols(), data.model.white);
  start[0] = 1e-4 * data.model.white;  // the floor
  const LevelFit fit = fit_levels(density, start);
  return {fit.log_likelihood, fit.level[fit.level.size() - 1], fit.level[0]};
}

std::vector<Evidence> examine(const FullRate& data) {
  if (data.colour.band_limited() || data.spectrum.empty() || data.spectrum[0].power.empty()) {
    return {};
  }
  const double nyquist = 0.5 / data.dt_s;
  const double none = fit_shape(data, [](double) { return 1.0; }).log_likelihood;
  const auto at = [&](double log_corner) {
    const double corner = std::exp(log_corner);
    return fit_shape(data, [&](double f) { return butterworth_gain(f, corner, data.dt_s); }).log_likelihood;
  };
  const double low = std::log(0.02 * nyquist);
  const double high = std::log(0.995 * nyquist);
  double best = high;
  double top = -1e300;
  for (int i = 0; i <= 40; ++i) {
    const double x = low + (high - low) * i / 40.0;
    const double l = at(x);
    if (l > top) {
      top = l;
      best = x;
    }
  }
  if (2.0 * (top - none) < 8.0) {
    return {};
  }
  double width = (high - low) / 40.0;
  for (int i = 0; i < 22; ++i) {
    width *= 0.6;
    for (const double x : {best - width, best + width}) {
      const double l = x > low && x < high ? at(x) : -1e300;
      if (l > top) {
        top = l;
        best = x;
      }
    }
  }
  if (best < low + 0.01 * (high - low)) {  // no band below the corner is left to see it from
    return {};
  }
  const Shape shape = fit_shape(data, [&](double f) { return butterworth_gain(f, std::exp(best), data.dt_s); });
  if (!data.given && shape.floor > kFilled * shape.density) {
    return {};
  }
  Evidence evidence;
  evidence.members = all_members(*data.group);
  evidence.gain = 2.0 * (top - none);
  // A first-order low-pass beside white noise is a fast Gauss-Markov process, another cause.
  double first_order = none;
  for (double f = 0.02 * nyquist; f < nyquist; f *= 1.3) {
    const double phi = std::exp(-2.0 * std::numbers::pi * f * data.dt_s);
    const Shape slower = fit_shape(data, [&](double g) {
      return (1.0 - phi) * (1.0 - phi) /
             (1.0 - 2.0 * phi * std::cos(2.0 * std::numbers::pi * g * data.dt_s) + phi * phi);
    });
    first_order = std::max(first_order, slower.log_likelihood);
  }
  evidence.score = std::min(evidence.gain - 3.0, 2.0 * (top - first_order));
  evidence.shape = std::exp(best);
  const Interval interval{profile_end(best, -1e-3, top, 3.8415, low, at),
                          profile_end(best, 1e-3, top, 3.8415, high, at)};
  evidence.parameters = {{"corner_hz",
                          {std::exp(best), {std::exp(interval.low), std::exp(interval.high)}},
                          units::hertz(data.group->unit)}};
  return {evidence};
}

double log_gain(const FullRate& data, const Evidence& found) {
  return fit_shape(data, [&](double f) { return butterworth_gain(f, found.shape, data.dt_s); }).log_likelihood -
         fit_shape(data, [](double) { return 1.0; }).log_likelihood;
}

/// Second-order Butterworth low-pass, bilinear transform.
void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  const double w = std::tan(std::numbers::pi * values[0] * draft.recording->dt_s);
  const double norm = 1.0 / (1.0 + std::numbers::sqrt2 * w + w * w);
  const double b0 = w * w * norm;
  const double a1 = 2.0 * (w * w - 1.0) * norm;
  const double a2 = (1.0 - std::numbers::sqrt2 * w + w * w) * norm;
  double x1 = 0.0;
  double x2 = 0.0;
  double y1 = 0.0;
  double y2 = 0.0;
  for (double& v : draft.white) {
    const double x = v;
    v = b0 * (x + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
    x2 = x1;
    x1 = x;
    y2 = y1;
    y1 = v;
  }
}

bool in_unit(const Evidence& found, UnitAxis& axis) {
  axis.bandwidth_hz = found.parameters[0].estimate.value;
  return true;
}

std::vector<double> shown_values(const Stage& stage, Random& random) {
  return {stage.rate_hz * (0.2 + 0.1 * random.uniform())};
}

}  // namespace

Cause band_limited_noise() {
  return {.name = "band_limited_noise",
          .title = "white noise that a low-pass filter has narrowed",
          .equation = "S(f) = N² / (1 + (f / corner)⁴), N² the density of the white noise at low frequency",
          .family = BandLimit{.examine = examine, .log_gain = log_gain},
          .rivals = {"gauss_markov"},
          .needs = "any recording",
          .separates = "the data sheet of the filter; a recording with another filter setting",
          .parameters = {{"corner_hz", units::hertz}},
          .inject = inject_effect,
          .in_unit = in_unit,
          .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
