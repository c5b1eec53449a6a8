#include "core/process/flicker_noise.hpp"

#include "core/process/dense.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/haar_differences.hpp"
#include "core/process/stationary_increments.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace driftlab {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kEulerGamma = 0.57721566490153286061;

/// Ten-point Gauss-Legendre rule on [low, high].
template <class Function>
double integrate_panel(double low, double high, const Function& f) {
  constexpr std::array<double, 5> kNode{0.14887433898163121, 0.43339539412924719, 0.67940956829902441,
                                        0.86506336668898451, 0.97390652851717172};
  constexpr std::array<double, 5> kWeight{0.29552422471475287, 0.26926671930999636, 0.21908636251598204,
                                          0.14945134915058059, 0.06667134430868814};
  const double centre = 0.5 * (low + high);
  const double half = 0.5 * (high - low);
  double sum = 0.0;
  for (std::size_t i = 0; i < kNode.size(); ++i) {
    sum += kWeight[i] * (f(centre - half * kNode[i]) + f(centre + half * kNode[i]));
  }
  return half * sum;
}

constexpr int kTabulated = 40;

/// Cin(pi k) for whole k.
double cin_pi(double k) {
  static const std::array<double, kTabulated> shared_table = [] {
    std::array<double, kTabulated> table{};
    for (int i = 1; i < kTabulated; ++i) {
      table[i] = table[i - 1];
      for (int part = 0; part < 4; ++part) {
        table[i] += integrate_panel(kPi * (i - 1 + 0.25 * part), kPi * (i - 1 + 0.25 * (part + 1)), [](double t) {
          const double s = std::sin(0.5 * t);
          return 2.0 * s * s / t;
        });
      }
    }
    return table;
  }();
  if (k < kTabulated) {
    return shared_table[static_cast<std::size_t>(k)];
  }
  // Ci(x) = -cos(x) g(x) at whole multiples of pi; g ~ 1/x^2 (1 - 3!/x^2 + 5!/x^4 - ...), x > 125.
  const double x = kPi * k;
  const double inverse = 1.0 / (x * x);
  const double g = inverse * (1.0 - 6.0 * inverse * (1.0 - 20.0 * inverse * (1.0 - 42.0 * inverse)));
  const double sign = std::fmod(k, 2.0) == 0.0 ? 1.0 : -1.0;
  return kEulerGamma + std::log(x) + sign * g;
}

/// r(u) = 1/(u sin^2 u) - 1/u^3 - 1/(3u) = sum_{k>=2} (2k-1) 2 zeta(2k) u^(2k-3) / pi^(2k), |u| < pi.
struct Remainder {
  static constexpr int kTerms = 34;
  std::array<double, kTerms> coefficient{};
  Remainder() {
    double power = std::pow(kPi, -4.0);
    for (int k = 2; k < kTerms + 2; ++k) {
      coefficient[k - 2] = (2 * k - 1) * 2.0 * std::riemann_zeta(2.0 * k) * power;
      power /= kPi * kPi;
    }
  }
  [[nodiscard]] double value(double u) const {
    double sum = 0.0;
    for (int i = kTerms - 1; i >= 0; --i) {
      sum = sum * u * u + coefficient[i];
    }
    return sum * u;
  }
  /// int_0^u r
  [[nodiscard]] double integral(double u) const {
    double sum = 0.0;
    for (int i = kTerms - 1; i >= 0; --i) {
      sum = sum * u * u + coefficient[i] / (2 * i + 2);
    }
    return sum * u * u;
  }
};

const Remainder& remainder_series() {
  static const Remainder shared_series;
  return shared_series;
}

/// int_0^{pi/2} sin^4(mu) r(u) du. sin^4 = 3/8 - cos(2mu)/2 + cos(4mu)/8; for large m by parts.
double remainder_integral(double m) {
  const Remainder& r = remainder_series();
  constexpr double kEnd = 0.5 * kPi;
  if (m < 64.0) {
    const int panels = 2 * static_cast<int>(m) + 2;
    double sum = 0.0;
    for (int i = 0; i < panels; ++i) {
      sum += integrate_panel(kEnd * i / panels, kEnd * (i + 1) / panels, [&](double u) {
        const double s = std::sin(m * u);
        return s * s * s * s * r.value(u);
      });
    }
    return sum;
  }
  const double a2 = 1.0 / (kEnd * kEnd);
  const double first_end = a2 * (-1.0 + 3.0 * a2 + 1.0 / 3.0);
  const double third_end = a2 * (-6.0 - 6.0 * a2 + 60.0 * a2 * a2 + 2.0 * a2);
  const auto cosine_integral = [&](double frequency, double cosine_at_end) {
    const double inverse = 1.0 / (frequency * frequency);
    return inverse * (cosine_at_end * first_end - 1.0 / 15.0) -
           inverse * inverse * (cosine_at_end * third_end - 4.0 / 63.0);
  };
  const double sign = std::fmod(m, 2.0) == 0.0 ? 1.0 : -1.0;
  return 0.375 * r.integral(kEnd) - 0.5 * cosine_integral(2.0 * m, sign) + 0.125 * cosine_integral(4.0 * m, 1.0);
}

double unit_haar_variance(double m) {
  const double odd = std::fmod(m, 2.0) == 0.0 ? 0.0 : 1.0;
  const double end = 0.5 * kPi * m;
  const double ci_difference = cin_pi(2.0 * m) - cin_pi(m);
  const double cubic = ci_difference - 0.5 * odd / (end * end);
  const double linear = (0.5 * cin_pi(m) - 0.125 * cin_pi(2.0 * m)) / 3.0;
  return (cubic + (linear + remainder_integral(m)) / (m * m)) / kPi;
}

/// The values for m = 1 .. 63, which cost a numerical integral each, and for the octaves beyond are made once.
double cached_unit_haar_variance(double m) {
  constexpr int kFirst = 6;
  static const std::array<double, 64> shared_table = [] {
    std::array<double, 64> table{};
    for (int i = 1; i < 64; ++i) {
      table[i] = unit_haar_variance(i);
    }
    return table;
  }();
  static const std::array<double, 36> shared_octaves = [] {
    std::array<double, 36> octaves{};
    for (std::size_t k = 0; k < octaves.size(); ++k) {
      octaves[k] = unit_haar_variance(std::ldexp(1.0, kFirst + static_cast<int>(k)));
    }
    return octaves;
  }();
  if (m < 64.0) {
    return shared_table[static_cast<std::size_t>(m)];
  }
  int exponent = 0;
  const bool octave = std::frexp(m, &exponent) == 0.5;
  const auto place = static_cast<std::size_t>(exponent - 1 - kFirst);
  return octave && place < shared_octaves.size() ? shared_octaves[place] : unit_haar_variance(m);
}

/// K with second difference -V/2 for B = 1: K(h) = -(1/pi) sum_{k<h} (h - k) Cin(pi k). Summed below kExact; above, by
/// the logarithm of Barnes' G function, sum_{k<h} (h - k) ln k = ln G(h + 1), and the limit of the alternating part.
class LagTable {
 public:
  LagTable() {
    double first = 0.0;   // sum of Cin
    double second = 0.0;  // sum of sums
    double a0 = 0.0;
    double a1 = 0.0;
    for (int h = 0; h < kExact; ++h) {
      exact_[h] = -second / kPi;
      const double cin = cin_pi(h);
      first += cin;
      second += first;
      if (h > 0) {
        const double wave = cin - kEulerGamma - std::log(kPi * h);                    // (-1)^h g(pi h)
        const double share = h + 2 < kExact ? 1.0 : (h + 2 == kExact ? 0.75 : 0.25);  // averaged partial sums
        a0 += share * wave;
        a1 += share * h * wave;
      }
    }
    slope_ = a0;
    offset_ = -a1;
  }
  [[nodiscard]] double value(double h) const {
    if (h < kExact) {
      return exact_[static_cast<std::size_t>(h)];
    }
    constexpr double kZetaPrime = -0.16542114370045092921;  // zeta'(-1)
    const double log_h = std::log(h);
    const double inverse = 1.0 / (h * h);
    const double barnes = 0.5 * h * h * log_h - 0.75 * h * h + 0.5 * h * std::log(2.0 * kPi) - log_h / 12.0 +
                          kZetaPrime - inverse / 240.0;
    return -((kEulerGamma + std::log(kPi)) * 0.5 * h * (h - 1.0) + barnes + slope_ * h + offset_) / kPi;
  }

 private:
  static constexpr int kExact = 4096;
  std::array<double, kExact> exact_{};
  double slope_ = 0.0;
  double offset_ = 0.0;
};

/// Sum of Gauss-Markov processes in place of 1/f: x = beta dt of each and its variance for B = 1.
struct PoleSum {
  static constexpr int kPoles = 16;
  static constexpr double kFastest = 2.5;
  static constexpr double kPerDecade = 2.0;
  static constexpr double kLowest = 1e-7;  ///< cycles a sample
  Eigen::VectorXd x = Eigen::VectorXd(kPoles);
  Eigen::VectorXd variance;
  double worst = 0.0;  ///< relative error of the density

  PoleSum() {
    for (int k = 0; k < kPoles; ++k) {
      x(k) = kFastest * std::pow(10.0, -k / kPerDecade);
    }
    constexpr int kPoints = 600;
    Eigen::MatrixXd share(kPoints, kPoles);  // of the density that each pole gives at unit variance
    for (int i = 0; i < kPoints; ++i) {
      const double f = kLowest * std::pow(0.5 / kLowest, i / (kPoints - 1.0));
      const double s = std::sin(kPi * f);
      for (int k = 0; k < kPoles; ++k) {
        const double gap = -std::expm1(-x(k));
        share(i, k) = 2.0 * kPi * f * gap * (2.0 - gap) / (gap * gap + 4.0 * (1.0 - gap) * s * s);
      }
    }
    variance = least_squares(share, Eigen::VectorXd(Eigen::VectorXd::Ones(kPoints)));
    worst = (share * variance - Eigen::VectorXd::Ones(kPoints)).cwiseAbs().maxCoeff();
  }
};

/// A process that has decayed within a block is held by its variance and its covariance of neighbouring block means,
/// without a remainder. Its exact remainder is the negative of many times that variance (36 times at beta L dt = 6),
/// which white noise beside weak flicker can give and white noise beside strong flicker cannot.
void keep_two_moments(BlockStates& states) {
  const double variance = states.p0[0] + states.remainder;
  states.phi[0] *= states.p0[0] / variance;
  states.p0[0] = variance;
  states.q[0] = variance * (1.0 - states.phi[0] * states.phi[0]);
  states.remainder = 0.0;
}

/// Of beta L dt. What keep_two_moments gets wrong, the covariance over two blocks, is 4 % of the variance here and
/// comes out as 11 %; of what is faster it is less.
constexpr double kFast = 2.0;

}  // namespace

double FlickerNoise::haar_variance(double m, double /*dt_s*/) const { return b * b * cached_unit_haar_variance(m); }

void FlickerNoise::haar_gradient(double m, double /*dt_s*/, std::span<double> out) const {
  out[0] = 2.0 * b * cached_unit_haar_variance(m);
}

std::optional<double> FlickerNoise::spectral_density(double f_hz, double /*dt_s*/) const {
  return b * b / (2.0 * kPi * std::fabs(f_hz));
}

double FlickerNoise::variogram(double lag, double /*dt_s*/) const { return 2.0 * b * b / kPi * cin_pi(std::fabs(lag)); }

double FlickerNoise::haar_cross(double mi, double mj, double h, double /*dt_s*/) const {
  const double reach = mi + mj;
  if (h > 8.0 * reach) {  // far lags: differences are derivatives of -V/2 ~ -ln(h)/pi, two terms of the Taylor series
    const double square = 1.0 / (h * h);
    const double smooth = -mi * mj / (4.0 * kPi) * square * (1.0 + 0.5 * (mi * mi + mj * mj) * square);
    // Cutting the density off at the Nyquist frequency leaves a wave of two samples, which only odd filters pass.
    const bool odd = std::fmod(mi, 2.0) == 1.0 && std::fmod(mj, 2.0) == 1.0;
    const double wave = std::fmod(h, 2.0) == 0.0 ? -1.0 : 1.0;
    return b * b * (smooth + (odd ? wave * square / (mi * mj * kPi * kPi * kPi) : 0.0));
  }
  static const LagTable shared_table;
  return b * b * haar_cross_of(mi, mj, h, [](double lag) { return shared_table.value(std::fabs(lag)); });
}

std::optional<StateSpace> FlickerNoise::state_space(double dt_s) const {
  static const PoleSum shared_poles;
  const Eigen::VectorXd phi = (-shared_poles.x).array().exp();
  StateSpace model;
  model.phi = phi.asDiagonal();
  model.cov0 = (b * b * shared_poles.variance).asDiagonal();
  model.q = (b * b * shared_poles.variance.array() * (1.0 - phi.array().square())).matrix().asDiagonal();
  model.h = Eigen::RowVectorXd::Ones(PoleSum::kPoles);
  model.mean0 = Eigen::VectorXd::Zero(PoleSum::kPoles);
  model.relative_error = shared_poles.worst;
  model.lowest_hz = PoleSum::kLowest / dt_s;
  return model;
}

void FlickerNoise::add_path(Random& random, double /*dt_s*/, std::span<double> out) const {
  std::vector<double> increments(embedding_lags(out.size()));
  for (std::size_t h = 0; h < increments.size(); ++h) {
    const double lag = static_cast<double>(h);
    increments[h] = (cin_pi(lag + 1.0) + cin_pi(std::fabs(lag - 1.0)) - 2.0 * cin_pi(lag)) * b * b / kPi;
  }
  add_path_of_increments(increments, random, out);
}

void FlickerNoise::add_block_states(double square, double /*shape*/, const Blocks& blocks, BlockStates& states) {
  constexpr int kStates = 6;
  const double low = std::log(2.0 * blocks.dt_s / std::numbers::pi);
  const double high = std::log(2.0 * blocks.longest_s);
  const double step = (high - low) / kStates;
  for (int i = 0; i < kStates; ++i) {
    const double beta = std::exp(-(low + (i + 0.5) * step));
    BlockStates one;
    GaussMarkov::add_block_states(square * step / std::numbers::pi, beta, blocks, one);
    if (blocks.block > 1 && beta * blocks.block_s() > kFast) {
      keep_two_moments(one);
    }
    states.phi.push_back(one.phi[0]);
    states.q.push_back(one.q[0]);
    states.p0.push_back(one.p0[0]);
    states.remainder += one.remainder;
  }
}

double FlickerNoise::expected_periodogram(double square, double /*shape*/, double f_hz, double /*dt_s*/,
                                          double /*samples*/) {
  return square / (2.0 * std::numbers::pi * f_hz);
}

}  // namespace driftlab
