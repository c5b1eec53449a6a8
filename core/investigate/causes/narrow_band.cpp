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
  const double dt = data.dt_s;
  Beaten beaten;
  beaten.step_s = static_cast<double>(block) * dt;
  const std::size_t blocks = e.size() / block + (e.size() % block != 0 ? 1 : 0);
  beaten.sums.reserve(blocks);
  const std::complex<double> more = std::polar(1.0, -kTurn * sweep.slope_hz_s * dt * dt);
  for (std::size_t b = 0; b < blocks && !data.stopped(); ++b) {
    const double begin_s = static_cast<double>(b * block) * dt;
    std::complex<double> turn = std::polar(1.0, -sweep.phase(begin_s));
    std::complex<double> next = std::polar(1.0, sweep.phase(begin_s) - sweep.phase(begin_s + dt));
    std::complex<double> sum = 0.0;
    for (std::size_t i = b * block; i < std::min(e.size(), (b + 1) * block); ++i) {
      if (data.used[r][i] != 0) {
        sum += std::clamp(e[i], -6.0, 6.0) * turn;
        beaten.samples += 1.0;
      }
      turn = times(turn, next);
      next = times(next, more);
    }
    beaten.sums.push_back(sum);
  }
  return beaten;
}

BandPower::BandPower(const FullRate& data, std::size_t r) {
  const std::size_t n = fast_length(data.innovation[r].size());
  if (n == 0 || data.stopped()) {
    return;
  }
  const auto z = half_spectrum_of(data.innovation[r].part(0, n), 0, data.stop);
  df_hz_ = 1.0 / (static_cast<double>(n) * data.dt_s);
  sums_.reserve(z.size() + 1);
  sums_.push_back(0.0);
  for (const std::complex<double>& value : z) {
    sums_.push_back(sums_.back() + std::min(12.0, std::norm(value) / static_cast<double>(n)));  // a line is no noise
  }
}

double BandPower::most_between(double low_hz, double high_hz) const {
  if (sums_.empty()) {
    return 1.0;
  }
  const std::size_t size = sums_.size() - 1;
  const auto width = static_cast<std::size_t>(std::max(24.0, 0.25 / df_hz_));
  const auto from = static_cast<std::size_t>(std::max(1.0, std::min(low_hz, high_hz) / df_hz_));
  const auto to = static_cast<std::size_t>(std::max(0.0, std::max(low_hz, high_hz)) / df_hz_);
  double most = 1.0;
  for (std::size_t k = from > width / 2 ? from - width / 2 : 1; k < std::min(to + 1, size); k += width) {
    const std::size_t end = std::min(k + width, size);
    if (end > k + 4) {
      most = std::max(most, (sums_[end] - sums_[k]) / static_cast<double>(end - k));
    }
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
  const double level = data.innovation_sd * data.innovation_sd * BandPower(data, r).most_between(lowest, highest);
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
