#include "core/investigate/causes/narrow_band.hpp"

#include "core/process/distributions.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/turns.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
double Sweep::phase(double t) const { return kTurn * (f_hz * t + 0.5 * slope_hz_s * t * t); }

Beaten beat(const FullRate& data, std::size_t r, const Sweep& sweep, std::size_t block) {
  const Series& e = data.innovation[r];
  Beaten beaten;
  beaten.step_s = static_cast<double>(block) * data.dt_s;
  beaten.sums.resize(e.size() / block + (e.size() % block != 0 ? 1 : 0));
  for (std::size_t i = 0; i < e.size() && !polled(data.stop, i); ++i) {
    if (data.used[r][i] != 0) {
      const double clipped = std::clamp(e[i], -6.0, 6.0);
      beaten.sums[i / block] += std::polar(clipped, -sweep.phase(static_cast<double>(i) * data.dt_s));
      beaten.samples += 1.0;
    }
  }
  return beaten;
}

double excess_between(const FullRate& data, std::size_t r, double low_hz, double high_hz) {
  if (data.stopped()) {
    return 1.0;
  }
  const std::size_t n = fast_length(data.innovation[r].size());
  const auto z = transform(data.innovation[r].part(0, n));
  const double df = 1.0 / (static_cast<double>(n) * data.dt_s);
  const auto width = static_cast<std::size_t>(std::max(24.0, 0.25 / df));
  const auto from = static_cast<std::size_t>(std::max(1.0, std::min(low_hz, high_hz) / df));
  const auto to = static_cast<std::size_t>(std::max(low_hz, high_hz) / df);
  double most = 1.0;
  for (std::size_t k = from > width / 2 ? from - width / 2 : 1; k < std::min(to + 1, z.size()); k += width) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t j = k; j < std::min(k + width, z.size()); ++j) {
      sum += std::min(12.0, std::norm(z[j]) / static_cast<double>(n));  // a line is no excess of the noise
      count += 1.0;
    }
    most = count > 4.0 ? std::max(most, sum / count) : most;
  }
  return most;
}

double log_tail(double x, double k) {
  if (x <= 2.0 * k) {
    return 0.0;
  }
  // P(chi2_{2k} > x) = exp(-x/2) sum_{j<k} (x/2)^j / j!, by its largest terms.
  double sum = 1.0;
  double term = 1.0;
  for (double j = k - 1.0; j > 0.0; j -= 1.0) {
    term *= j / (0.5 * x);
    sum += term;
  }
  return -0.5 * x + (k - 1.0) * std::log(0.5 * x) - log_gamma(k) + std::log(sum);
}

PhaseFit fit_phases(const FullRate& data, std::size_t r, const std::vector<Sweep>& sweeps) {
  const Series& y = data.residual[r];
  const auto width = static_cast<Eigen::Index>(2 * sweeps.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(width, width);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(width);
  Eigen::VectorXd row(width);
  double mean = 0.0;
  double used = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    mean += data.used[r][i] != 0 ? y[i] : 0.0;
    used += data.used[r][i] != 0 ? 1.0 : 0.0;
  }
  mean /= std::max(1.0, used);
  const auto fill = [&](std::size_t i) {
    for (std::size_t k = 0; k < sweeps.size(); ++k) {
      const double phase = sweeps[k].phase(static_cast<double>(i) * data.dt_s);
      row(static_cast<Eigen::Index>(2 * k)) = std::cos(phase);
      row(static_cast<Eigen::Index>(2 * k + 1)) = std::sin(phase);
    }
  };
  for (std::size_t i = 0; i < y.size() && !polled(data.stop, i); ++i) {
    if (data.used[r][i] != 0) {
      fill(i);
      gram.noalias() += row * row.transpose();
      right += row * (y[i] - mean);
    }
  }
  PhaseFit fit;
  fit.amplitude.assign(sweeps.size(), 0.0);
  fit.values.assign(y.size(), 0.0);
  if (used < 10.0 * static_cast<double>(width)) {
    fit.variance = 1e300;
    return fit;
  }
  const Eigen::VectorXd solved = gram.ldlt().solve(right);
  for (std::size_t k = 0; k < sweeps.size(); ++k) {
    fit.amplitude[k] = {solved(static_cast<Eigen::Index>(2 * k)), -solved(static_cast<Eigen::Index>(2 * k + 1))};
  }
  for (std::size_t i = 0; i < y.size() && !polled(data.stop, i); ++i) {
    fill(i);
    fit.values[i] = row.dot(solved);
  }
  // The noise about the oscillation is that of the innovations there.
  double lowest = sweeps.front().f_hz;
  double highest = lowest;
  for (const Sweep& sweep : sweeps) {
    const double end = sweep.at(static_cast<double>(y.size()) * data.dt_s);
    lowest = std::min({lowest, sweep.f_hz, end});
    highest = std::max({highest, sweep.f_hz, end});
  }
  const double level = data.innovation_sd * data.innovation_sd * excess_between(data, r, lowest, highest);
  fit.variance = 2.0 * level / used;
  return fit;
}

std::vector<std::vector<std::size_t>> scopes_of(const FullRate& data) {
  std::vector<std::vector<std::size_t>> scopes{all_members(*data.group)};
  for (std::size_t r = 0; data.members() > 1 && r < data.members(); ++r) {
    scopes.push_back({r});
  }
  return scopes;
}

double log_gain_of(std::complex<double> fitted, double variance, double amplitude) {
  const double x = amplitude * std::abs(fitted) / variance;
  const double log_bessel = x < 50.0 ? std::log(std::cyl_bessel_i(0.0, x)) : x - 0.5 * std::log(kTurn * x);
  return log_bessel - 0.5 * amplitude * amplitude / variance;
}

}  // namespace driftlab::investigate
