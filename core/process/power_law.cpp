#include "core/process/power_law.hpp"

#include "core/process/dense.hpp"
#include "core/process/distributions.hpp"
#include "core/process/haar_differences.hpp"
#include "core/process/stationary_increments.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace driftlab {
namespace {

using std::numbers::pi;

/// A value and its derivative by delta = alpha - 1.
struct Dual {
  double value = 0.0;
  double slope = 0.0;
};

/// ln(1 + u delta)/delta.
Dual log_ratio(double u, double delta) {
  const double z = u * delta;
  if (std::fabs(z) < 0.05) {
    Dual sum;
    double power = u;  // u (-z)^(k - 1)
    for (double k = 1.0; k <= 13.0; ++k) {
      sum.value += power / k;
      sum.slope -= k / (k + 1.0) * power * u;
      power *= -z;
    }
    return sum;
  }
  const double value = std::log1p(z) / delta;
  return {value, (u / (1.0 + z) - value) / delta};
}

/// (e^x - 1)/x and its derivative by x.
Dual growth(double x) {
  if (std::fabs(x) < 0.3) {
    Dual sum{1.0, 0.0};
    double term = 1.0;  // x^(k - 1)/(k + 1)!
    for (double k = 1.0; k <= 12.0; ++k) {
      term *= (k == 1.0 ? 1.0 : x) / (k + 1.0);
      sum.value += term * x;
      sum.slope += k * term;
    }
    return sum;
  }
  const double rise = std::expm1(x);
  return {rise / x, (x * (rise + 1.0) - rise) / (x * x)};
}

/// ln of Gamma(h + 1/2 + eta)/Gamma(h + 1/2 - eta) over its value at eta_0, divided by delta: eta = eta_0 + delta/2.
/// From kFar on by Stirling's series, whose terms are -2 B_(k+1)(1/2 + eta)/(k (k + 1) h^k), k = 2, 4, 6, 8; below by
/// steps from there.
class LogGammaRatio {
 public:
  LogGammaRatio(double eta_0, double delta) : eta_0_(eta_0), delta_(delta) {
    const double eta = eta_0 + 0.5 * delta;
    constexpr std::array<std::array<double, 5>, 4> kTerms{{
        {1.0 / 12.0, -1.0 / 3.0, 0.0, 0.0, 0.0},
        {-7.0 / 480.0, 1.0 / 12.0, -1.0 / 10.0, 0.0, 0.0},
        {31.0 / 4032.0, -7.0 / 144.0, 1.0 / 12.0, -1.0 / 21.0, 0.0},
        {-127.0 / 15360.0, 31.0 / 576.0, -49.0 / 480.0, 1.0 / 12.0, -1.0 / 36.0},
    }};
    // (eta^p - eta_0^p)/delta for p = 1, 3, ... is half the sum of eta^j eta_0^(p - 1 - j) over j < p.
    std::array<Dual, 5> odd;
    Dual sum{1.0, 0.0};  // and its derivative by eta
    double power = 1.0;  // eta^(p - 1)
    for (int p = 1; p <= 9; ++p) {
      if (p % 2 == 1) {
        odd[static_cast<std::size_t>(p / 2)] = {0.5 * sum.value, 0.25 * sum.slope};
      }
      sum = {eta_0 * sum.value + eta * power, eta_0 * sum.slope + p * power};
      power *= eta;
    }
    for (std::size_t k = 0; k < kTerms.size(); ++k) {
      for (std::size_t i = 0; i < odd.size(); ++i) {
        series_[k].value += kTerms[k][i] * odd[i].value;
        series_[k].slope += kTerms[k][i] * odd[i].slope;
      }
    }
  }

  [[nodiscard]] Dual at(double h) const {
    const double from = std::max(h, kFar);
    const double inverse = 1.0 / (from * from);
    Dual sum{std::log(from), 0.0};
    double power = 1.0;
    for (const Dual& term : series_) {
      power *= inverse;
      sum.value += term.value * power;
      sum.slope += term.slope * power;
    }
    for (double k = h; k < from; k += 1.0) {
      const Dual up = log_ratio(0.5 / (k + 0.5 + eta_0_), delta_);
      const Dual down = log_ratio(-0.5 / (k + 0.5 - eta_0_), delta_);
      sum.value -= up.value - down.value;
      sum.slope -= up.slope - down.slope;
    }
    return sum;
  }

 private:
  static constexpr double kFar = 16.0;
  double eta_0_;
  double delta_;
  std::array<Dual, 4> series_{};
};

/// E(h) = [r(h) - (h^2 - 1/4)]/delta at eta = 1 + delta/2.
class LagFunction {
 public:
  explicit LagFunction(double alpha) : delta_(alpha - 1.0), ratio_(1.0, delta_) {}

  [[nodiscard]] Dual at(double lag) const {
    const double h = std::fabs(lag);
    const Dual log = ratio_.at(h);
    const Dual rise = growth(delta_ * log.value);
    const double square = h * h - 0.25;
    return {square * log.value * rise.value,
            square * (log.slope * rise.value + log.value * rise.slope * (log.value + delta_ * log.slope))};
  }

 private:
  double delta_;
  LogGammaRatio ratio_;
};

/// A of the header, and its derivative by alpha.
Dual amplitude(double alpha) {
  const double value = std::sin(0.5 * pi * alpha) * std::exp(log_gamma(2.0 - alpha)) / (pi * alpha * (1.0 + alpha));
  const double slope = 0.5 * pi * std::cos(0.5 * pi * alpha) / std::sin(0.5 * pi * alpha) - digamma(2.0 - alpha) -
                       1.0 / alpha - 1.0 / (1.0 + alpha);
  return {value, value * slope};
}

/// Haar wavelet variance of innovations of variance 1.
Dual unit_haar(double alpha, double m) {
  const LagFunction lag_function(alpha);
  const Dual a = amplitude(alpha);
  const Dual two = lag_function.at(2.0 * m);
  const Dual one = lag_function.at(m);
  const Dual zero = lag_function.at(0.0);
  const double scale = 0.25 / (m * m);
  const double value = scale * (2.0 * two.value - 8.0 * one.value + 6.0 * zero.value);
  const double slope = scale * (2.0 * two.slope - 8.0 * one.slope + 6.0 * zero.slope);
  return {a.value * value, a.slope * value + a.value * slope};
}

/// Variances of Gauss-Markov processes whose densities add up to |2 sin(pi f)|^-alpha.
struct PoleSum {
  static constexpr int kPoles = 16;
  static constexpr double kFastest = 4.0;
  static constexpr double kPerDecade = 2.0;
  static constexpr double kLowest = 1e-7;  ///< cycles a sample
  Eigen::VectorXd x = Eigen::VectorXd(kPoles);
  Eigen::VectorXd variance;
  double worst = 0.0;  ///< relative error of the density

  explicit PoleSum(double alpha) {
    constexpr int kPoints = 600;
    Eigen::MatrixXd share(kPoints, kPoles);  // of the density that each pole gives at unit variance
    for (int k = 0; k < kPoles; ++k) {
      x(k) = kFastest * std::pow(10.0, -k / kPerDecade);
    }
    for (int i = 0; i < kPoints; ++i) {
      const double s = std::sin(pi * kLowest * std::pow(0.5 / kLowest, i / (kPoints - 1.0)));
      const double inverse = std::pow(2.0 * s, alpha);
      for (int k = 0; k < kPoles; ++k) {
        const double gap = -std::expm1(-x(k));
        share(i, k) = inverse * gap * (2.0 - gap) / (gap * gap + 4.0 * (1.0 - gap) * s * s);
      }
    }
    const Eigen::VectorXd largest = share.colwise().maxCoeff();
    share *= largest.cwiseInverse().asDiagonal();
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(kPoints);
    Eigen::Index negative = 0;
    variance = least_squares(share, ones);
    while (variance.minCoeff(&negative) < 0.0) {  // the slowest, near alpha = 1.9
      share.col(negative).setZero();
      variance = least_squares(share, ones);
    }
    worst = (share * variance - ones).cwiseAbs().maxCoeff();
    variance = variance.cwiseQuotient(largest);
  }
};

}  // namespace

double PowerLaw::innovation_variance(double dt_s) const { return b * b * std::pow(2.0 * pi * dt_s, alpha - 1.0); }

double PowerLaw::haar_variance(double m, double dt_s) const {
  return innovation_variance(dt_s) * unit_haar(alpha, m).value;
}

void PowerLaw::haar_gradient(double m, double dt_s, std::span<double> out) const {
  const Dual unit = unit_haar(alpha, m);
  const double square = innovation_variance(dt_s);
  out[0] = 2.0 * square * unit.value / b;
  out[1] = square * (unit.slope + std::log(2.0 * pi * dt_s) * unit.value);
}

std::optional<double> PowerLaw::spectral_density(double f_hz, double dt_s) const {
  const double s = std::fabs(scaled_phase(f_hz * dt_s, 1.0).sine);
  return dt_s * innovation_variance(dt_s) * std::pow(2.0 * s, -alpha);
}

std::optional<double> PowerLaw::autocovariance(double lag, double dt_s) const {
  if (alpha >= 1.0) {
    return std::nullopt;
  }
  const double delta = alpha - 1.0;
  const double ratio = std::exp(delta * LogGammaRatio(0.0, delta).at(std::fabs(lag)).value);
  return innovation_variance(dt_s) * std::exp(log_gamma(1.0 - alpha)) * std::sin(0.5 * pi * alpha) / pi * ratio;
}

/// 2 sin(pi alpha/2) Gamma(2 - alpha)/pi [r(h) - r(0)]/delta at eta = delta/2.
double PowerLaw::variogram(double lag, double dt_s) const {
  const double delta = alpha - 1.0;
  const LogGammaRatio ratio(0.0, delta);
  const double from = ratio.at(0.0).value;
  const double rise = ratio.at(std::fabs(lag)).value - from;
  const double difference = std::exp(delta * from) * rise * growth(delta * rise).value;
  return 2.0 * innovation_variance(dt_s) * std::sin(0.5 * pi * alpha) / pi * std::exp(log_gamma(2.0 - alpha)) *
         difference;
}

void PowerLaw::add_haar_cross(double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                              std::span<double> out) const {
  const double scale = factor * innovation_variance(dt_s) * amplitude(alpha).value;
  const double far = 0.25 * scale * mi * mj * (alpha + 1.0) * alpha * (alpha - 2.0);
  const double next = (mi * mi + mj * mj) / 12.0 * (alpha - 3.0) * (alpha - 4.0);
  const LagFunction lag_function(alpha);
  for (std::size_t i = 0; i < lags.size(); ++i) {
    const double h = lags[i];
    if (h > 8.0 * (mi + mj)) {  // far lags: differences are derivatives of h^(alpha + 1)/delta
      out[i] += far * std::pow(h, alpha - 3.0) * (1.0 + next / (h * h));
    } else {
      out[i] -= scale * haar_cross_of(mi, mj, h, [&](double lag) { return lag_function.at(lag).value; });
    }
  }
}

std::optional<StateSpace> PowerLaw::state_space(double dt_s) const {
  const PoleSum poles(alpha);
  const Eigen::VectorXd phi = (-poles.x).array().exp();
  const Eigen::VectorXd square = innovation_variance(dt_s) * poles.variance;
  StateSpace model;
  model.phi = phi.asDiagonal();
  model.cov0 = square.asDiagonal();
  model.q = (square.array() * (1.0 - phi.array().square())).matrix().asDiagonal();
  model.h = Eigen::RowVectorXd::Ones(PoleSum::kPoles);
  model.mean0 = Eigen::VectorXd::Zero(PoleSum::kPoles);
  model.relative_error = poles.worst;
  model.lowest_hz = PoleSum::kLowest / dt_s;
  return model;
}

void PowerLaw::add_path(Random& random, double dt_s, std::span<double> out) const {
  // Increments are fractional noise of order alpha/2 - 1, whose autocovariances follow by ratios from that at lag 0,
  // Gamma(3 - alpha)/Gamma(2 - alpha/2)^2: Gamma(h + d)/Gamma(h + 1 - d) rises by (h + d)/(h + 1 - d), d = alpha/2 - 1.
  const double d = 0.5 * alpha - 1.0;
  double covariance = innovation_variance(dt_s) * std::exp(log_gamma(1.0 - 2.0 * d) - 2.0 * log_gamma(1.0 - d));
  std::vector<double> increments(embedding_lags(out.size()));
  for (std::size_t h = 0; h < increments.size(); ++h) {
    increments[h] = covariance;
    const auto lag = static_cast<double>(h);
    covariance *= (lag + d) / (lag + 1.0 - d);
  }
  add_path_of_increments(increments, random, out);
}

}  // namespace driftlab
