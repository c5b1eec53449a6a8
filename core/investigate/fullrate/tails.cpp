#include "core/investigate/fullrate/tails.hpp"

#include "core/investigate/fullrate/golden_section.hpp"
#include "core/investigate/slow/profile.hpp"
#include "core/process/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab::investigate {
namespace {

/// Width of a bin [standard deviations], which stands at the root mean square of its members. Chosen, not measured.
constexpr double kWidth = 0.05;
/// Innovations beyond are kept one by one: of a Gaussian 4e-33 are.
constexpr double kTop = 12.0;
/// Innovations beyond this many standard deviations count as this: one of them must not decide a width.
constexpr double kCut = 1000.0;

double gaussian(const InnovationHistogram& h, double variance) {
  return -0.5 * (h.samples * std::log(variance) + h.square / variance) -
         0.5 * h.samples * std::log(2.0 * std::numbers::pi);
}

/// Log likelihood of a unit-variance Student-t of 1/nu times sqrt(variance).
double student(const InnovationHistogram& h, double inverse_nu, double variance) {
  const double nu = 1.0 / inverse_nu;
  const double s2 = variance * (nu - 2.0);
  const double constant = log_gamma(0.5 * (nu + 1.0)) - log_gamma(0.5 * nu) - 0.5 * std::log(std::numbers::pi * s2);
  double sum = 0.0;
  for (std::size_t j = 0; j < h.centre.size(); ++j) {
    if (h.count[j] > 0.0) {
      sum += h.count[j] * (constant - 0.5 * (nu + 1.0) * std::log1p(h.centre[j] * h.centre[j] / s2));
    }
  }
  return sum;
}

double mixture(const InnovationHistogram& h, double fraction, double magnitude, double variance) {
  const double constant = -0.5 * std::log(2.0 * std::numbers::pi * variance);
  double sum = 0.0;
  for (std::size_t j = 0; j < h.centre.size(); ++j) {
    if (!(h.count[j] > 0.0)) {
      continue;
    }
    const double e = h.centre[j];
    const double body = -0.5 * e * e / variance;
    const double minus = -0.5 * (e - magnitude) * (e - magnitude) / variance;
    const double plus = -0.5 * (e + magnitude) * (e + magnitude) / variance;
    const double top = std::max(body, minus);
    const double density =
        (1.0 - fraction) * std::exp(body - top) + 0.5 * fraction * (std::exp(minus - top) + std::exp(plus - top));
    sum += h.count[j] * (constant + top + std::log(density));
  }
  return sum;
}

/// Binning adds about width^2/12 to the square within a bin; the Gaussian is evaluated on the same centres.
double gaussian_binned(const InnovationHistogram& h, double variance) { return mixture(h, 0.0, 0.0, variance); }

}  // namespace

namespace {

/// What each recording's innovations are divided by.
std::vector<double> levels_of(const FullRate& data) {
  std::vector<double> level(data.members(), 1.0);
  std::vector<double> samples(data.members(), 0.0);
  double square = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < data.members(); ++r) {
    double own = 0.0;
    for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
      if (data.used[r][i] != 0) {
        own += std::min(data.innovation[r][i] * data.innovation[r][i], 25.0);
        samples[r] += 1.0;
      }
    }
    square += own;
    count += samples[r];
    level[r] = own;
  }
  for (std::size_t r = 0; r < data.members(); ++r) {
    const bool known = samples[r] > 0.0 && level[r] > 0.0;
    level[r] = known ? std::sqrt(level[r] / samples[r] / (square / count)) : 1.0;
  }
  return level;
}

}  // namespace

InnovationHistogram histogram_of(const FullRate& data, bool own_levels) {
  const std::vector<double> level = own_levels ? levels_of(data) : std::vector<double>(data.members(), 1.0);
  InnovationHistogram h;
  const auto bins = static_cast<std::size_t>(kTop / kWidth);
  std::vector<double> square(bins, 0.0);
  h.centre.assign(bins, 0.0);
  h.count.assign(bins, 0.0);
  for (std::size_t r = 0; r < data.members(); ++r) {
    for (std::size_t i = 0; i < data.innovation[r].size(); ++i) {
      if (data.used[r][i] == 0) {
        continue;
      }
      const double e = std::min(kCut, std::fabs(data.innovation[r][i] / level[r]));
      h.samples += 1.0;
      h.square += e * e;
      const auto bin = static_cast<std::size_t>(e / kWidth);
      if (bin < bins) {
        h.count[bin] += 1.0;
        square[bin] += e * e;
      } else {
        h.centre.push_back(e);
        h.count.push_back(1.0);
      }
    }
  }
  for (std::size_t j = 0; j < bins; ++j) {  // a bin stands at the root mean square of its members
    h.centre[j] = h.count[j] > 0.0 ? std::sqrt(square[j] / h.count[j]) : (static_cast<double>(j) + 0.5) * kWidth;
  }
  return h;
}

TailFit fit_student(const InnovationHistogram& h, bool scale_known) {
  TailFit fit;
  if (h.samples < 500.0) {
    return fit;
  }
  const double own = h.square / h.samples;
  const double free_gaussian = gaussian(h, own);
  const double null = scale_known ? gaussian(h, 1.0) : free_gaussian;
  const auto at_free = [&](double x) {
    const double v = golden_section(std::log(0.5 * own), std::log(1.5 * own), 18,
                                    [&](double log_v) { return student(h, x, std::exp(log_v)); });
    return student(h, x, std::exp(v));
  };
  const std::function<double(double)> at_known = [&](double x) { return student(h, x, 1.0); };
  const std::function<double(double)> at = scale_known ? at_known : std::function<double(double)>(at_free);
  const auto over_log = [&](const std::function<double(double)>& f) {
    return std::exp(golden_section(std::log(1e-4), std::log(0.45), 30, [&](double l) { return f(std::exp(l)); }));
  };
  fit.value = over_log(at);
  const double top = at(fit.value);
  fit.gain = 2.0 * (top - null);
  fit.gain_free_scale = scale_known ? 2.0 * (at_free(over_log(at_free)) - free_gaussian) : fit.gain;
  if (fit.gain <= 0.0) {
    return {};
  }
  fit.interval = {profile_end(fit.value, -0.2 * fit.value, top, 3.8415, 1e-5, at),
                  profile_end(fit.value, 0.2 * fit.value, top, 3.8415, 0.45, at)};
  return fit;
}

MixtureFit fit_mixture(const InnovationHistogram& h, bool scale_known) {
  MixtureFit fit;
  if (h.samples < 500.0) {
    return fit;
  }
  const double own = h.square / h.samples;
  const double null_free = gaussian_binned(h, own);
  const double null = scale_known ? gaussian_binned(h, 1.0) : null_free;
  // For each magnitude the best fraction (and scale); the profile over magnitudes has its top near the outliers.
  struct Point {
    double fraction, variance, log_likelihood;
  };
  const auto at = [&](double magnitude, bool known) {
    double v = known ? 1.0 : own;
    double p = 1e-4;
    for (int round = 0; round < (known ? 1 : 3); ++round) {
      p = std::exp(golden_section(std::log(1e-6), std::log(0.1), 24,
                                  [&](double log_p) { return mixture(h, std::exp(log_p), magnitude, v); }));
      if (!known) {
        v = std::exp(golden_section(std::log(0.8 * v), std::log(1.1 * v), 16,
                                    [&](double log_v) { return mixture(h, p, magnitude, std::exp(log_v)); }));
      }
    }
    return Point{p, v, mixture(h, p, magnitude, v)};
  };
  const auto search = [&](bool known) {
    double best = 0.0;
    double top = -1e300;
    for (double m = 2.5; m < 60.0; m *= 1.15) {
      const double l = at(m, known).log_likelihood;
      if (l > top) {
        top = l;
        best = m;
      }
    }
    return golden_section(best / 1.15, best * 1.15, 12, [&](double m) { return at(m, known).log_likelihood; });
  };
  fit.magnitude = search(scale_known);
  const Point top = at(fit.magnitude, scale_known);
  fit.fraction = top.fraction;
  fit.gain = 2.0 * (top.log_likelihood - null);
  fit.gain_free_scale = fit.gain;
  if (scale_known) {
    fit.gain_free_scale = 2.0 * (at(search(false), false).log_likelihood - null_free);
  }
  if (fit.gain <= 0.0) {
    return {};
  }
  const auto by_log_fraction = [&](double log_p) { return mixture(h, std::exp(log_p), fit.magnitude, top.variance); };
  const auto by_magnitude = [&](double m) { return mixture(h, fit.fraction, m, top.variance); };
  const double centre = std::log(fit.fraction);
  fit.fraction_interval = {std::exp(profile_end(centre, -0.3, top.log_likelihood, 3.8415, -20.0, by_log_fraction)),
                           std::exp(profile_end(centre, 0.3, top.log_likelihood, 3.8415, -1.0, by_log_fraction))};
  fit.magnitude_interval = {profile_end(fit.magnitude, -0.1, top.log_likelihood, 3.8415, 0.5, by_magnitude),
                            profile_end(fit.magnitude, 0.1, top.log_likelihood, 3.8415, 200.0, by_magnitude)};
  // The magnitude is read off innovations whose own scale is uncertain; with a free scale it shares that scale.
  return fit;
}

double student_gain(const InnovationHistogram& h, double inverse_nu, bool scale_known) {
  const double own = h.square / h.samples;
  if (scale_known) {
    return student(h, inverse_nu, 1.0) - gaussian(h, 1.0);
  }
  const double v = golden_section(std::log(0.5 * own), std::log(1.5 * own), 18,
                                  [&](double log_v) { return student(h, inverse_nu, std::exp(log_v)); });
  return student(h, inverse_nu, std::exp(v)) - gaussian(h, own);
}

double mixture_gain(const InnovationHistogram& h, double fraction, double magnitude, bool scale_known) {
  const double own = h.square / h.samples;
  if (scale_known) {
    return mixture(h, fraction, magnitude, 1.0) - gaussian_binned(h, 1.0);
  }
  const double v = golden_section(std::log(0.5 * own), std::log(1.1 * own), 20,
                                  [&](double log_v) { return mixture(h, fraction, magnitude, std::exp(log_v)); });
  return mixture(h, fraction, magnitude, std::exp(v)) - gaussian_binned(h, own);
}

void to_normal_scores(FullRate& data, const std::function<double(double)>& tail) {
  const auto score = [&](double e) { return normal_quantile(1.0 - std::clamp(tail(e), 1e-15, 0.5)); };
  std::vector<double> table;  // a score is smooth: on a grid of kWidth lines between are off by less than 1e-3
  for (double e = 0.0; e < kTop + 2.0 * kWidth; e += kWidth) {
    table.push_back(score(e));
  }
  for (Series& series : data.innovation) {
    std::vector<double> scores = series.values();
    for (double& e : scores) {
      const double modulus = std::fabs(e);
      double value = 0.0;
      if (modulus < kTop) {
        const double place = modulus / kWidth;
        const auto at = static_cast<std::size_t>(place);
        value = table[at] + (place - static_cast<double>(at)) * (table[at + 1] - table[at]);
      } else {
        value = score(modulus);
      }
      e = std::copysign(value, e);
    }
    series = std::move(scores);
  }
}

}  // namespace driftlab::investigate
