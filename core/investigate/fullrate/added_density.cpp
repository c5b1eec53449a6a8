#include "core/investigate/fullrate/added_density.hpp"

#include "core/investigate/fullrate/whittle.hpp"
#include "core/investigate/slow/profile.hpp"
#include "core/investigate/study/measured_constants.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

bool in_scope(const std::vector<std::size_t>& scope, std::size_t r) {
  return std::find(scope.begin(), scope.end(), r) != scope.end();
}

/// All recordings stacked: level column first, then N^2 where it is free.
LinearDensity stack(const FullRate& data, const std::vector<std::size_t>& scope, double (*shape)(double, double)) {
  Eigen::Index bins = 0;
  for (const Spectrum& s : data.spectrum) {
    bins += static_cast<Eigen::Index>(s.power.size());
  }
  LinearDensity density;
  density.power.resize(bins);
  density.weight.resize(bins);
  density.fixed.resize(bins);
  density.shape = Eigen::MatrixXd::Zero(bins, data.given ? 1 : 2);
  Eigen::Index row = 0;
  for (std::size_t r = 0; r < data.spectrum.size(); ++r) {
    const Spectrum& s = data.spectrum[r];
    for (std::size_t j = 0; j < s.power.size(); ++j, ++row) {
      density.power[row] = s.power[j];
      density.weight[row] = s.weight[j];
      density.fixed[row] = data.slow[r][j] + (data.given ? data.model.white : 0.0);
      density.shape(row, 0) = in_scope(scope, r) ? shape(s.f_hz[j], data.dt_s) : 0.0;
      if (!data.given) {
        density.shape(row, 1) = 1.0;
      }
    }
  }
  return density;
}

AddedDensity against_model(const FullRate& data, const std::vector<std::size_t>& scope,
                           double (*shape)(double, double)) {
  const LinearDensity density = stack(data, scope, shape);
  LinearDensity none = density;
  Eigen::VectorXd start(data.given ? 1 : 2);
  double before = 0.0;
  if (data.given) {
    before = whittle(density.power, density.weight, density.fixed);
    start << 1e-3 * data.model.white / shape(0.25 / data.dt_s, data.dt_s);
  } else {
    none.shape = density.shape.rightCols(1);
    const LevelFit fit = fit_levels(none, Eigen::VectorXd::Constant(1, data.model.white));
    before = fit.log_likelihood;
    start << 1e-3 * fit.level[0] / shape(0.25 / data.dt_s, data.dt_s), fit.level[0];
  }
  const LevelFit fit = fit_levels(density, start);
  const double sd = std::sqrt(std::max(0.0, fit.covariance(0, 0)));
  return {fit.level[0], {fit.level[0] - 1.96 * sd, fit.level[0] + 1.96 * sd}, 2.0 * (fit.log_likelihood - before)};
}

/// Profile over the free common spectrum: per bin the maximum over S > 0 of -sum m_r [ln E_r + P_r/E_r], E_r = S + x_r.
double best_common(double sum_m, const std::vector<double>& m, const std::vector<double>& p,
                   const std::vector<double>& x) {
  double s = 0.0;
  for (std::size_t r = 0; r < m.size(); ++r) {
    s += m[r] * std::max(0.05 * p[r], p[r] - x[r]) / sum_m;
  }
  for (int i = 0; i < 20; ++i) {  // Fisher scoring, kept positive
    double score = 0.0;
    double information = 0.0;
    for (std::size_t r = 0; r < m.size(); ++r) {
      const double e = s + x[r];
      score += m[r] * (p[r] - e) / (e * e);
      information += m[r] / (e * e);
    }
    const double next = std::max(0.2 * s, s + score / information);
    if (std::fabs(next - s) < 1e-10 * s) {
      break;
    }
    s = next;
  }
  double l = 0.0;
  for (std::size_t r = 0; r < m.size(); ++r) {
    const double e = s + x[r];
    l -= m[r] * (std::log(e) + p[r] / e);
  }
  return l;
}

/// Recordings as long as those of the scope, and how many of them lie outside it.
struct Alike {
  std::vector<std::size_t> members;
  std::size_t outside = 0;
};

Alike alike_with(const FullRate& data, const std::vector<std::size_t>& scope) {
  Alike alike;
  for (std::size_t r = 0; r < data.spectrum.size(); ++r) {
    if (data.spectrum[r].samples == data.spectrum[scope.front()].samples && !data.spectrum[r].power.empty()) {
      alike.members.push_back(r);
      alike.outside += in_scope(scope, r) ? 0 : 1;
    }
  }
  return alike;
}

/// Below this share of the white density a bin holds what the periodogram leaks from elsewhere: one number of each
/// recording, its two ends, and no density.
constexpr double kStopBand = 1e-4;

/// Log likelihood with the level in the scope and a free common spectrum, which the recordings of the scope repeat up
/// to the factor `repeat`.
double common_likelihood(const FullRate& data, const std::vector<std::size_t>& scope, const Alike& alike,
                         double (*shape)(double, double), double level, double repeat = 1.0) {
  const std::size_t count = alike.members.size();
  std::vector<double> m(count);
  std::vector<double> p(count);
  std::vector<double> x(count);
  double sum = 0.0;
  for (std::size_t j = 0; j < data.spectrum[scope.front()].power.size(); ++j) {
    const bool empty = std::all_of(alike.members.begin(), alike.members.end(), [&](std::size_t r) {
      return data.spectrum[r].power[j] < kStopBand * data.model.white;
    });
    if (empty) {
      continue;
    }
    double sum_m = 0.0;
    for (std::size_t a = 0; a < count; ++a) {
      const Spectrum& s = data.spectrum[alike.members[a]];
      const bool inside = in_scope(scope, alike.members[a]);
      const double factor = inside ? repeat : 1.0;
      m[a] = s.weight[j];
      p[a] = s.power[j] / factor;
      x[a] = inside ? level * shape(s.f_hz[j], data.dt_s) / factor : 0.0;
      sum_m += m[a];
      sum -= m[a] * std::log(factor);
    }
    sum += best_common(sum_m, m, p, x);
  }
  return sum;
}

/// The power of a sensor's noise repeats from recording to recording to about this share, twice that of its level.
constexpr double kPowerRepeats = 2.0 * kLevelRepeats;

/// The top of a likelihood over that factor, log-normal around 1, as a nuisance.
template <class Likelihood>
double over_repeats(const Likelihood& at) {
  double top = -1e300;
  double best = 0.0;
  double width = 1.0;
  for (int i = 0; i < 12; ++i, width *= 0.7) {
    for (const double z : {best - width, best, best + width}) {
      const double l = at(std::exp(kPowerRepeats * z)) - 0.5 * z * z;
      if (l > top) {
        top = l;
        best = z;
      }
    }
  }
  return top;
}

AddedDensity against_each_other(const FullRate& data, const std::vector<std::size_t>& scope,
                                double (*shape)(double, double)) {
  const Spectrum& reference = data.spectrum[scope.front()];
  const Alike alike = alike_with(data, scope);
  if (alike.outside == 0 || reference.power.empty()) {
    return {};
  }
  const auto at = [&](double level) { return common_likelihood(data, scope, alike, shape, level); };
  const double unit = reference.power.back() / shape(0.5 / data.dt_s, data.dt_s);
  const double none = at(0.0);
  double best = 0.0;
  double top = none;
  for (double x = 1e-3; x < 3.0; x *= 1.6) {
    const double l = at(x * unit);
    if (l > top) {
      top = l;
      best = x * unit;
    }
  }
  if (best == 0.0) {
    return {};
  }
  double width = 0.4 * best;
  for (int i = 0; i < 14; ++i, width *= 0.6) {
    for (const double x : {best - width, best + width}) {
      const double l = at(x);
      if (l > top) {
        top = l;
        best = x;
      }
    }
  }
  if (2.0 * (top - none) < 8.0) {  // no finding: its size is not asked for
    return {best, {0.0, 2.0 * best}, 2.0 * (top - none)};
  }
  // The gain stands as found; size and interval say what is left of it where levels do not repeat exactly.
  const auto repeating = [&](double level) {
    return over_repeats([&](double factor) { return common_likelihood(data, scope, alike, shape, level, factor); });
  };
  double value = best;
  double summit = repeating(value);
  width = 0.2 * best;
  for (int i = 0; i < 8; ++i, width *= 0.6) {
    for (const double x : {value - width, value + width}) {
      const double l = x > 0.0 ? repeating(x) : summit;
      if (l > summit) {
        summit = l;
        value = x;
      }
    }
  }
  return {value,
          {profile_end(value, -0.2 * value, summit, 3.8415, 0.0, repeating),
           profile_end(value, 0.2 * value, summit, 3.8415, 1e3 * value, repeating)},
          2.0 * (top - none)};
}

}  // namespace

AddedDensity fit_added_density(const FullRate& data, const std::vector<std::size_t>& scope,
                               double (*shape)(double f_hz, double dt_s)) {
  for (const std::size_t r : scope) {
    if (data.spectrum[r].power.empty()) {
      return {};
    }
  }
  if (data.flat || data.given) {
    return against_model(data, scope, shape);
  }
  return against_each_other(data, scope, shape);
}

double added_density_gain(const FullRate& data, const std::vector<std::size_t>& scope,
                          double (*shape)(double f_hz, double dt_s), double level) {
  if (!data.flat && !data.given) {
    const Alike alike = alike_with(data, scope);
    return common_likelihood(data, scope, alike, shape, level) - common_likelihood(data, scope, alike, shape, 0.0);
  }
  LinearDensity density = stack(data, scope, shape);
  const Eigen::VectorXd added = level * density.shape.col(0);
  if (data.given) {
    return whittle(density.power, density.weight, density.fixed + added) -
           whittle(density.power, density.weight, density.fixed);
  }
  density.shape = Eigen::MatrixXd(density.shape.rightCols(1));
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(1, data.model.white);
  const double without = fit_levels(density, start).log_likelihood;
  density.fixed += added;
  return fit_levels(density, start).log_likelihood - without;
}

}  // namespace driftlab::investigate
