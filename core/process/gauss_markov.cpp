#include "core/process/gauss_markov.hpp"

#include "core/process/haar_differences.hpp"
#include "core/process/haar_series.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace driftlab {
namespace {

using haar_series::haar_bump;
using haar_series::sinh_minus;
using haar_series::sinh_of;
using haar_series::sinh_rest;

/// Above this x = beta dt the process is white noise to the last bit, and sinh would overflow before long.
constexpr double kWhite = 40.0;

/// The variance at sigma = 1, and what it is made of.
struct UnitHaar {
  double variance = 0.0;
  double s = 0.0;          ///< sinh(x/2)
  double numerator = 0.0;  ///< 2 m (sinh x - x) + p(m x)
};

UnitHaar unit_haar(double x, double m) {
  if (x > kWhite) {
    return {.variance = 0.5 / m};
  }
  const double s = sinh_of(0.5 * x);
  const double numerator = 2.0 * m * sinh_minus(x) + haar_bump(m * x);
  return {numerator / (8.0 * m * m * s * s), s, numerator};
}

}  // namespace

double GaussMarkov::haar_variance(double m, double dt_s) const {
  return sigma * sigma * unit_haar(beta * dt_s, m).variance;
}

void GaussMarkov::haar_gradient(double m, double dt_s, std::span<double> out) const {
  const double x = beta * dt_s;
  const UnitHaar unit = unit_haar(x, m);
  out[0] = 2.0 * sigma * unit.variance;
  if (x > kWhite) {
    out[1] = 0.0;
    return;
  }
  // d ln(numerator)/dx - d ln(denominator)/dx; p'(y) = 2 (1 - e^-y)^2.
  const double t = std::expm1(-m * x);
  const double slope =
      (4.0 * m * unit.s * unit.s + 2.0 * m * t * t) / unit.numerator - std::sqrt(1.0 + unit.s * unit.s) / unit.s;
  out[1] = sigma * sigma * unit.variance * slope * dt_s;
}

void GaussMarkov::haar_curve(std::span<const double> half, double dt_s, std::span<double> variance,
                             std::span<double> gradient) const {
  const double x = beta * dt_s;
  const bool white = x > kWhite;
  const double square = sigma * sigma;
  const double s = white ? 1.0 : sinh_of(0.5 * x);
  const double minus = white ? 0.0 : sinh_minus(x);
  const double cotangent = std::sqrt(1.0 + s * s) / s;
  for (std::size_t j = 0; j < half.size(); ++j) {
    const double m = half[j];
    if (white) {
      variance[j] = square * (0.5 / m);
      if (!gradient.empty()) {
        gradient[2 * j] = 2.0 * sigma * (0.5 / m);
        gradient[2 * j + 1] = 0.0;
      }
      continue;
    }
    const double y = m * x;
    const bool small = y < 0.5;
    const double t = small && gradient.empty() ? 0.0 : std::expm1(-y);
    const double numerator = 2.0 * m * minus + (small ? haar_bump(y) : 2.0 * (y + t) - t * t);
    const double unit = numerator / (8.0 * m * m * s * s);
    variance[j] = square * unit;
    if (!gradient.empty()) {
      gradient[2 * j] = 2.0 * sigma * unit;
      gradient[2 * j + 1] = square * unit * ((4.0 * m * s * s + 2.0 * m * t * t) / numerator - cotangent) * dt_s;
    }
  }
}

std::optional<double> GaussMarkov::spectral_density(double f_hz, double dt_s) const {
  const double x = beta * dt_s;
  const double phi = std::exp(-x);
  const double gap = -std::expm1(-x);  // 1 - phi
  const double s = scaled_phase(f_hz * dt_s, 1.0).sine;
  return dt_s * sigma * sigma * gap * (1.0 + phi) / (gap * gap + 4.0 * phi * s * s);
}

std::optional<double> GaussMarkov::autocovariance(double lag, double dt_s) const {
  return sigma * sigma * std::exp(-beta * dt_s * std::fabs(lag));
}

LowFrequencyDensity GaussMarkov::low_frequency(double dt_s) const {
  return {spectral_density(0.0, dt_s).value_or(0.0), beta / (6.0 * std::numbers::pi)};
}

double GaussMarkov::variogram(double lag, double dt_s) const {
  return -2.0 * sigma * sigma * std::expm1(-beta * dt_s * std::fabs(lag));
}

double GaussMarkov::haar_cross(double mi, double mj, double h, double dt_s) const {
  const double x = beta * dt_s;
  if (x > kWhite) {
    return h >= mi + mj ? 0.0
                        : sigma * sigma * haar_cross_of(mi, mj, h, [](double lag) { return 0.5 * std::fabs(lag); });
  }
  const double s = std::sinh(0.5 * x);
  const double scale = sigma * sigma / (4.0 * s * s);
  if (h >= mi + mj) {  // only the exponential is left, and its differences are products
    const double a = std::expm1(-x * mi);
    const double b = std::expm1(-x * mj);
    return -scale * std::exp(-x * (h - mi - mj)) * a * a * b * b / (4.0 * mi * mj);
  }
  const double reach = x * (h + mi + mj);
  if (reach > 1.0) {
    const double sinh_x = std::sinh(x);
    return scale * haar_cross_of(mi, mj, h, [x, sinh_x](double lag) {
             const double distance = std::fabs(lag);
             const double fallen = x * distance;  // beyond 60 the exponential is lost beside the rest's rounding
             return (fallen < 60.0 ? std::exp(-fallen) : 0.0) + distance * sinh_x;
           });
  }
  // K = cosh(xh) - [ (sinh x|h| - x|h|) - |h| (sinh x - x) ]: differences of cosh are products of sinh.
  const double a = 2.0 * std::sinh(0.5 * x * mi);
  const double b = 2.0 * std::sinh(0.5 * x * mj);
  const double even = -std::cosh(x * h) * a * a * b * b / (4.0 * mi * mj);
  const double rest = sinh_minus(x);
  const double odd = haar_cross_of(mi, mj, h, [x, rest](double lag) {
    const double distance = std::fabs(lag);
    return distance * rest - sinh_minus(x * distance);
  });
  return scale * (even + odd);
}

namespace {

/// The nine points of two second differences of steps mi and mj: sum_k w_k f(|h + o_k|).
struct NinePoints {
  static constexpr std::size_t kPoints = 9;
  static constexpr std::array<double, kPoints> kWeight{4.0, -2.0, -2.0, -2.0, -2.0, 1.0, 1.0, 1.0, 1.0};
  std::array<double, kPoints> offset;

  NinePoints(double mi, double mj) : offset{0.0, mi, -mi, mj, -mj, mi + mj, mi - mj, mj - mi, -mi - mj} {}
};

/// exp(-x o_k) and exp(x o_k) of the nine points.
struct NinePowers {
  std::array<double, NinePoints::kPoints> down, up;

  NinePowers(double x, double mi, double mj) {
    const double i = std::exp(x * mi);
    const double j = std::exp(x * mj);
    up = {1.0, i, 1.0 / i, j, 1.0 / j, i * j, i / j, j / i, 1.0 / (i * j)};
    down = {1.0, up[2], up[1], up[4], up[3], up[8], up[7], up[6], up[5]};
  }
};

/// sum_k w_k [exp(-x |h + o_k|) + |h + o_k| sinh x] over the lags between two kinks, where no h + o_k changes its sign:
/// fall e^-xh + rise e^xh + level + slope h.
struct Stretch {
  double fall = 0.0;
  double rise = 0.0;
  double level = 0.0;
  double slope = 0.0;

  Stretch() = default;
  Stretch(const NinePoints& points, const NinePowers& powers, double sinh_x, double h) {
    for (std::size_t k = 0; k < NinePoints::kPoints; ++k) {
      const double weight = NinePoints::kWeight[k];
      const bool ahead = h + points.offset[k] >= 0.0;
      if (ahead) {
        fall += weight * powers.down[k];
      } else {
        rise += weight * powers.up[k];
      }
      const double signed_weight = (ahead ? weight : -weight) * sinh_x;
      level += signed_weight * points.offset[k];
      slope += signed_weight;
    }
  }
};

/// The same term by term, where powers of the points would overflow.
double plain_sum(const NinePoints& points, double x, double sinh_x, double h) {
  double sum = 0.0;
  for (std::size_t k = 0; k < NinePoints::kPoints; ++k) {
    const double distance = std::fabs(h + points.offset[k]);
    const double fallen = x * distance;  // beyond 60 the exponential is lost beside the rest's rounding
    sum += NinePoints::kWeight[k] * ((fallen < 60.0 ? std::exp(-fallen) : 0.0) + distance * sinh_x);
  }
  return sum;
}

/// sum_k w_k [(sinh x - x) |h + o_k| - (sinh x |h + o_k| - x |h + o_k|)] for x (h + mi + mj) <= 1, where seven terms of
/// the series of sinh are exact.
double odd_part(const NinePoints& points, double x, double h, double rest) {
  double sum = 0.0;
  for (std::size_t k = 0; k < NinePoints::kPoints; ++k) {
    const double distance = std::fabs(h + points.offset[k]);
    const double y = x * distance;
    const double s = y * y;
    sum += NinePoints::kWeight[k] * (distance * rest - y * s * sinh_rest(s));
  }
  return sum;
}

}  // namespace

void GaussMarkov::add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                                 std::span<double> out) const {
  const double x = beta * dt_s;
  const double s = sinh_of(0.5 * x);
  const double scale = factor * sigma * sigma / (16.0 * s * s * mi * mj);
  const double a = std::expm1(-x * mi);
  const double b = std::expm1(-x * mj);
  const double far = -scale * a * a * b * b;
  const bool bounded = x <= kWhite && x * (mi + mj) < 300.0;  // no power overflows
  const NinePoints points(mi, mj);
  const NinePowers powers(bounded ? x : 0.0, mi, mj);
  const double sinh_x = 2.0 * s * std::sqrt(1.0 + s * s);
  const double rest = sinh_minus(x);
  // (2 sinh(x mi/2) 2 sinh(x mj/2))^2, of which expm1 holds half each.
  const double even = a * a * b * b * powers.up[5];
  int known = -1;
  Stretch stretch;
  for (std::size_t i = 0; i < lags.size(); ++i) {
    const double h = lags[i];
    const double beyond = x * (h - mi - mj);
    if (beyond >= 0.0) {
      if (beyond < 200.0) {
        out[i] += far * std::exp(-beyond);
      }
      continue;
    }
    if (x > kWhite) {
      out[i] += factor * haar_cross(mi, mj, h, dt_s);
      continue;
    }
    if (!bounded) {  // and so far from single samples that the series below is not needed
      out[i] -= scale * plain_sum(points, x, sinh_x, h);
      continue;
    }
    const double decay = std::exp(-x * h);
    if (x * (h + mi + mj) <= 1.0) {
      const double cosh = 0.5 * (decay + 1.0 / decay);
      out[i] -= scale * (even * cosh + odd_part(points, x, h, rest));
      continue;
    }
    const int here = (h >= mi ? 1 : 0) + (h >= mj ? 1 : 0) + (h >= std::fabs(mj - mi) ? 1 : 0);
    if (here != known) {
      stretch = Stretch(points, powers, sinh_x, h);
      known = here;
    }
    out[i] -= scale * (stretch.fall * decay + stretch.rise / decay + stretch.level + stretch.slope * h);
  }
}

std::optional<StateSpace> GaussMarkov::state_space(double dt_s) const {
  StateSpace model;
  model.phi = Eigen::MatrixXd::Constant(1, 1, std::exp(-beta * dt_s));
  model.q = Eigen::MatrixXd::Constant(1, 1, -sigma * sigma * std::expm1(-2.0 * beta * dt_s));
  model.h = Eigen::RowVectorXd::Ones(1);
  model.mean0 = Eigen::VectorXd::Zero(1);
  model.cov0 = Eigen::MatrixXd::Constant(1, 1, sigma * sigma);
  return model;
}

void GaussMarkov::add_path(Random& random, double dt_s, std::span<double> out) const {
  const double phi = std::exp(-beta * dt_s);
  const double sd = sigma * std::sqrt(-std::expm1(-2.0 * beta * dt_s));
  double level = sigma * random.normal();
  for (double& value : out) {
    value += level;
    level = phi * level + sd * random.normal();
  }
}

void GaussMarkov::add_block_states(double square, double beta, const Blocks& blocks, BlockStates& states) {
  const auto block = static_cast<double>(blocks.block);
  const double x = beta * blocks.dt_s;
  const double phi_block = std::exp(-x * block);
  if (blocks.block == 1) {
    states.phi.push_back(phi_block);
    states.q.push_back(square * -std::expm1(-2.0 * x));
    states.p0.push_back(square);
    return;
  }
  const double phi = std::exp(-x);
  const double mean = std::expm1(-x * block) / (block * std::expm1(-x));  // (1-phi^L)/(L(1-phi))
  const double ar = square * std::exp(x * (block - 1.0)) * mean * mean;
  // lag 0: (1+phi)/(1-phi)/L - 2 phi (1-phi^L)/(L^2 (1-phi)^2); for small x by the series L - ... both agree to 1e-9
  double total = 0.0;
  if (x * block < 0.02) {
    double power = 1.0;
    total = block;
    for (double k = 1.0; k < block; ++k) {
      power *= phi;
      total += 2.0 * (block - k) * power;
    }
    total *= square / (block * block);
  } else {
    total = square * ((1.0 + phi) / (-std::expm1(-x)) / block - 2.0 * phi * mean / (block * -std::expm1(-x)));
  }
  states.phi.push_back(phi_block);
  states.q.push_back(ar * -std::expm1(-2.0 * x * block));
  states.p0.push_back(ar);
  states.remainder += total - ar;
}

double GaussMarkov::expected_periodogram(double square, double beta, double f_hz, double dt_s, double samples) {
  const double w = 2.0 * std::numbers::pi * f_hz * dt_s;
  const double phi = std::exp(-beta * dt_s);
  const std::complex<double> z = std::polar(phi, -w);
  const std::complex<double> one_minus = 1.0 - z;
  const double decay = -std::expm1(-beta * dt_s * samples);
  const std::complex<double> sum = 1.0 / one_minus - z * decay / (samples * one_minus * one_minus);
  return square * dt_s * (2.0 * sum.real() - 1.0);
}

}  // namespace driftlab
