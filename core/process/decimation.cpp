#include "core/process/decimation.hpp"

#include "core/process/haar_differences.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

double fourth_power(double x) { return (x * x) * (x * x); }

/// The quintic B-spline and its derivative, at u >= 0.
double spline(double u) {
  if (u < 1.0) {
    return 0.55 + u * u * (-0.5 + u * u * (0.25 - u / 12.0));
  }
  return u < 2.0   ? 0.425 + u * (0.625 + u * (-1.75 + u * (1.25 + u * (-0.375 + u / 24.0))))
         : u < 3.0 ? fourth_power(3.0 - u) * (3.0 - u) / 120.0
                   : 0.0;
}
double spline_slope(double u) {
  if (u < 1.0) {
    return u * (-1.0 + u * u * (1.0 - 5.0 * u / 12.0));
  }
  return u < 2.0   ? 0.625 + u * (-3.5 + u * (3.75 + u * (-1.5 + 5.0 * u / 24.0)))
         : u < 3.0 ? -fourth_power(3.0 - u) / 24.0
                   : 0.0;
}

/// The weight of noise that is x widths old: three boxes in a row.
double kernel(double x) {
  return x < 1.0 ? 0.5 * x * x : x < 2.0 ? x * (3.0 - x) - 1.5 : x < 3.0 ? 0.5 * (3.0 - x) * (3.0 - x) : 0.0;
}

/// Autocovariances from lag 0 to the last that is not zero, their sum over both signs being 1, and their derivatives by
/// the width.
struct Lags {
  std::vector<double> covariance;
  std::vector<double> slope;

  explicit Lags(double width) {
    double sum = 0.0;
    double sum_slope = 0.0;
    for (double h = 0.0; h < 3.0 * width; h += 1.0) {
      const double sides = h > 0.0 ? 2.0 : 1.0;
      covariance.push_back(spline(h / width));
      slope.push_back(-h / (width * width) * spline_slope(h / width));
      sum += sides * covariance.back();
      sum_slope += sides * slope.back();
    }
    for (std::size_t h = 0; h < covariance.size(); ++h) {
      slope[h] = (slope[h] - covariance[h] * sum_slope / sum) / sum;
      covariance[h] /= sum;
    }
  }
};

/// Covariance of Haar coefficients of white noise of variance 1.
double white_cross(double mi, double mj, double h) {
  return haar_cross_of(mi, mj, h, [](double lag) { return 0.5 * std::fabs(lag); });
}

double haar_sum(const std::vector<double>& covariance, double mi, double mj, double h) {
  double sum = 0.0;
  for (std::size_t k = 0; k < covariance.size(); ++k) {
    const auto lag = static_cast<double>(k);
    sum +=
        covariance[k] * (k == 0 ? white_cross(mi, mj, h) : white_cross(mi, mj, h - lag) + white_cross(mi, mj, h + lag));
  }
  return sum;
}

/// The same for one filter of half length m, whose own autocovariance is (2m - 3k)/4m^2 up to lag m and (k - 2m)/4m^2
/// from there to 2m.
double haar_sum_at(const std::vector<double>& covariance, double m) {
  double sum = 0.5 * m * covariance[0];
  for (std::size_t h = 1; h < covariance.size(); ++h) {
    const auto lag = static_cast<double>(h);
    sum += covariance[h] * (lag < m ? m - 1.5 * lag : std::min(0.0, 0.5 * lag - m));
  }
  return sum / (m * m);
}

/// Sum over both signs of the values, and of the values times the lags.
std::pair<double, double> moments_of(const std::vector<double>& covariance) {
  double sum = covariance[0];
  double first = 0.0;
  for (std::size_t h = 1; h < covariance.size(); ++h) {
    sum += 2.0 * covariance[h];
    first += 2.0 * static_cast<double>(h) * covariance[h];
  }
  return {sum, first};
}

/// What the noise of one sample interval gives to the present and the later samples: a column for each of the points at
/// which three-point Gauss-Legendre rules between the knots of the kernel take the interval. Products of two kernels
/// are of degree four there, so the rules are exact.
Eigen::MatrixXd shocks(double width, double variance_scale) {
  constexpr std::array<double, 3> kNode{-0.77459666924148338, 0.0, 0.77459666924148338};
  constexpr std::array<double, 3> kWeight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  std::vector<double> cuts{0.0, 1.0};
  for (double knot = 1.0; knot <= 3.0; knot += 1.0) {
    cuts.push_back(knot * width - std::floor(knot * width));
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  const auto states = static_cast<Eigen::Index>(std::ceil(3.0 * width));
  Eigen::MatrixXd columns(states, static_cast<Eigen::Index>(3 * (cuts.size() - 1)));
  Eigen::Index column = 0;
  for (std::size_t piece = 0; piece + 1 < cuts.size(); ++piece) {
    const double length = cuts[piece + 1] - cuts[piece];
    for (std::size_t p = 0; p < kNode.size(); ++p, ++column) {
      const double at = cuts[piece] + 0.5 * length * (1.0 + kNode[p]);
      const double scale = std::sqrt(variance_scale * kWeight[p] * length / width);
      for (Eigen::Index i = 0; i < states; ++i) {
        columns(i, column) = scale * kernel((static_cast<double>(i) + at) / width);
      }
    }
  }
  return columns;
}

/// Of the sample's variance to that of the spline.
double variance_scale(const Decimation& process, double dt_s) {
  return process.n * process.n / dt_s * Lags(process.samples).covariance[0] / spline(0.0);
}

}  // namespace

double Decimation::haar_variance(double m, double dt_s) const {
  return n * n / dt_s * haar_sum(Lags(samples).covariance, m, m, 0.0);
}

void Decimation::haar_gradient(double m, double dt_s, std::span<double> out) const {
  const Lags lags(samples);
  out[0] = 2.0 * n / dt_s * haar_sum(lags.covariance, m, m, 0.0);
  out[1] = n * n / dt_s * haar_sum(lags.slope, m, m, 0.0);
}

void Decimation::haar_curve(std::span<const double> half, double dt_s, std::span<double> variance,
                            std::span<double> gradient) const {
  const Lags lags(samples);
  const auto [sum, first] = moments_of(lags.covariance);
  const auto [slope_sum, slope_first] = moments_of(lags.slope);
  for (std::size_t j = 0; j < half.size(); ++j) {
    const double m = half[j];
    const bool line = m + 1.0 >= static_cast<double>(lags.covariance.size());
    const double unit = line ? (0.5 * sum - 0.75 * first / m) / m : haar_sum_at(lags.covariance, m);
    variance[j] = n * n / dt_s * unit;
    if (!gradient.empty()) {
      gradient[2 * j] = 2.0 * n / dt_s * unit;
      gradient[2 * j + 1] =
          n * n / dt_s * (line ? (0.5 * slope_sum - 0.75 * slope_first / m) / m : haar_sum_at(lags.slope, m));
    }
  }
}

std::optional<double> Decimation::spectral_density(double f_hz, double dt_s) const {
  const Lags lags(samples);
  double sum = lags.covariance[0];
  for (std::size_t h = 1; h < lags.covariance.size(); ++h) {
    sum += 2.0 * lags.covariance[h] * scaled_phase(2.0 * f_hz * dt_s, static_cast<double>(h)).cosine;
  }
  return n * n * std::max(0.0, sum);
}

LowFrequencyDensity Decimation::low_frequency(double dt_s) const { return {n * n, 0.103 / (samples * dt_s)}; }

std::optional<double> Decimation::autocovariance(double lag, double dt_s) const {
  return variance_scale(*this, dt_s) * spline(std::fabs(lag) / samples);
}

double Decimation::variogram(double lag, double dt_s) const {
  return 2.0 * variance_scale(*this, dt_s) * (spline(0.0) - spline(std::fabs(lag) / samples));
}

void Decimation::add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                                std::span<double> out) const {
  const Lags own(samples);
  const double scale = factor * n * n / dt_s;
  const double last = mi + mj + static_cast<double>(own.covariance.size());
  for (std::size_t i = 0; i < lags.size(); ++i) {
    if (lags[i] < last) {
      out[i] += scale * haar_sum(own.covariance, mi, mj, lags[i]);
    }
  }
}

std::optional<StateSpace> Decimation::state_space(double dt_s) const {
  const Eigen::MatrixXd columns = shocks(samples, variance_scale(*this, dt_s));
  const Eigen::Index states = columns.rows();
  if (states > kMostStates) {
    return std::nullopt;
  }
  StateSpace model;
  model.phi = Eigen::MatrixXd::Zero(states, states);
  model.phi.diagonal(1).setOnes();
  model.q = columns * columns.transpose();
  model.cov0 = model.q;
  for (Eigen::Index step = 1; step < states; ++step) {
    model.cov0.topLeftCorner(states - step, states - step) += model.q.bottomRightCorner(states - step, states - step);
  }
  model.h = Eigen::RowVectorXd::Unit(states, 0);
  model.mean0 = Eigen::VectorXd::Zero(states);
  return model;
}

void Decimation::add_path(Random& random, double dt_s, std::span<double> out) const {
  const Eigen::MatrixXd columns = shocks(samples, variance_scale(*this, dt_s));
  const auto states = static_cast<std::size_t>(columns.rows());
  std::vector<double> later(states, 0.0);  // a ring: what is known of this sample and the next ones
  Eigen::VectorXd kick(columns.cols());
  std::size_t now = 0;
  const auto draw = [&] {
    for (double& value : kick) {
      value = random.normal();
    }
    const Eigen::VectorXd given = columns * kick;
    for (std::size_t i = 0; i < states; ++i) {
      later[(now + i) % states] += given(static_cast<Eigen::Index>(i));
    }
  };
  const auto advance = [&] {
    later[now] = 0.0;
    now = (now + 1) % states;
  };
  for (std::size_t before = 1; before < states; ++before) {
    draw();
    advance();
  }
  for (double& value : out) {
    draw();
    value += later[now];
    advance();
  }
}

std::pair<double, double> Decimation::shape_range(double /*dt_s*/, double samples) {
  return {0.34, std::clamp(samples / 9.0, 1.0, kWidest)};
}

}  // namespace driftlab
