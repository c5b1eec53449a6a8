#include "core/process/damped_oscillation.hpp"

#include "core/process/haar_differences.hpp"
#include "core/process/haar_series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

using Complex = std::complex<double>;
using haar_series::expm1_of;
using haar_series::haar_bump;
using haar_series::sinh_minus;
using haar_series::sinh_of;

/// Above this decay per sample the process is white noise to the last bit, and sinh would overflow before long.
constexpr double kWhite = 40.0;

/// Ten-point Gauss-Legendre rule on [0, 1].
constexpr std::array<double, 5> kNode{0.14887433898163121, 0.43339539412924719, 0.67940956829902441,
                                      0.86506336668898451, 0.97390652851717172};
constexpr std::array<double, 5> kNodeWeight{0.29552422471475287, 0.26926671930999636, 0.21908636251598204,
                                            0.14945134915058059, 0.06667134430868814};

struct UnitHaar {
  Complex variance;
  Complex s;  ///< sinh(x/2)
};

UnitHaar unit_haar(const Complex& x, double m) {
  const Complex s = sinh_of(0.5 * x);
  return {(2.0 * m * sinh_minus(x) + haar_bump(m * x)) / (8.0 * m * m * s * s), s};
}

}  // namespace

DampedOscillation::DampedOscillation(double rate, double quality)
    : rate_(rate),
      damping_(0.5 / quality),
      root_(std::sqrt(std::max(1.0 - damping_ * damping_, 1e-8))),
      fall_(damping_ * rate),
      turn_(root_ * rate),
      weight_(1.0, damping_ / root_),
      x_(fall_, turn_) {
  if (turn_ > std::numbers::pi) {
    x_ = {fall_, std::remainder(turn_, 2.0 * std::numbers::pi)};
    folded_ = true;
  }
}

double DampedOscillation::haar_variance(double m) const {
  return fall_ > kWhite ? 0.5 / m : (weight_ * unit_haar(x_, m).variance).real();
}

/// dC/dzeta.
Complex DampedOscillation::weight_slope() const { return {0.0, 1.0 / (root_ * root_ * root_)}; }

/// dx/dzeta.
Complex DampedOscillation::rate_slope() const { return {rate_, -rate_ * damping_ / root_}; }

DampedOscillation::Slope DampedOscillation::haar_slope(double m) const {
  if (fall_ > kWhite) {
    return {};
  }
  const auto [value, s] = unit_haar(x_, m);
  const Complex t = expm1_of(-m * x_);
  // d numerator/dx = 4 m sinh^2(x/2) + 2 m (1 - e^-mx)^2; d ln denominator/dx = coth(x/2).
  const Complex slope = 0.5 / m + t * t / (4.0 * m * s * s) - value * std::cosh(0.5 * x_) / s;
  const double by_damping = (weight_slope() * value + weight_ * slope * rate_slope()).real();
  return {(weight_ * slope * Complex(damping_, root_)).real(), -2.0 * damping_ * damping_ * by_damping};
}

DampedOscillation::Shared DampedOscillation::shared() const {
  if (fall_ > kWhite) {
    return {};
  }
  const Complex s = sinh_of(0.5 * x_);
  return {sinh_minus(x_), 0.125 / (s * s), std::cosh(0.5 * x_) / s};
}

/// As unit_haar and haar_slope have it.
double DampedOscillation::haar_at(const Shared& shared, double m, Slope& slope) const {
  if (fall_ > kWhite) {
    return 0.5 / m;
  }
  const Complex y = m * x_;
  const Complex t = expm1_of(-y);
  const bool small = std::norm(y) < 0.25;
  const Complex bump = small ? haar_bump(y) : 2.0 * (y + t) - t * t;
  const double inverse = 1.0 / m;
  const Complex value = shared.scale * ((2.0 * inverse) * shared.minus + (inverse * inverse) * bump);
  const Complex by_x = 0.5 * inverse + (2.0 * inverse) * (t * t * shared.scale) - value * shared.cotangent;
  const double by_damping = (weight_slope() * value + weight_ * by_x * rate_slope()).real();
  slope = {(weight_ * by_x * Complex(damping_, root_)).real(), -2.0 * damping_ * damping_ * by_damping};
  return (weight_ * value).real();
}

double DampedOscillation::density(double f) const {
  if (fall_ > kWhite) {
    return 1.0;
  }
  // Re[C sinh x/(cosh x - cos w)] over one denominator, v = sin^2(w/2). C x has no real part, so that the first term is
  // of third order in a small x.
  const double wave = scaled_phase(f, 1.0).sine;
  const double v = wave * wave;
  const Complex s = sinh_of(0.5 * x_);
  const Complex conjugate_square = std::conj(s) * std::conj(s);
  const bool small = !folded_ && std::abs(x_) < 0.5;
  const double first = (weight_ * (small ? sinh_minus(x_) : std::sinh(x_))).real();
  const double second = (weight_ * sinh_of(x_) * conjugate_square).real();
  return (v * first + second) / (2.0 * std::norm(s * s + v));
}

double DampedOscillation::density_at_zero() const {
  return fall_ > kWhite ? 1.0 : (weight_ * std::cosh(0.5 * x_) / sinh_of(0.5 * x_)).real();
}

DampedOscillation::Slope DampedOscillation::density_slope_at_zero() const {
  if (fall_ > kWhite) {
    return {};
  }
  const Complex s = sinh_of(0.5 * x_);
  const Complex slope = -0.5 / (s * s);
  const double by_damping = (weight_slope() * std::cosh(0.5 * x_) / s + weight_ * slope * rate_slope()).real();
  return {(weight_ * slope * Complex(damping_, root_)).real(), -2.0 * damping_ * damping_ * by_damping};
}

double DampedOscillation::autocovariance(double lag) const {
  const double h = std::fabs(lag);
  const double angle = x_.imag() * h;
  return std::exp(-fall_ * h) * (std::cos(angle) + weight_.imag() * std::sin(angle));
}

double DampedOscillation::variogram(double lag) const {
  const double h = std::fabs(lag);
  const double half_angle = 0.5 * x_.imag() * h;
  const double sine = std::sin(half_angle);
  const double rise = 2.0 * sine * (sine - weight_.imag() * std::cos(half_angle));  // 1 - cos - (a/b) sin
  return 2.0 * (-std::expm1(-fall_ * h) + std::exp(-fall_ * h) * rise);
}

/// Of e^-x|h|; see GaussMarkov::haar_cross, term by term.
Complex DampedOscillation::haar_cross(double mi, double mj, double h) const {
  const Complex s = sinh_of(0.5 * x_);
  const Complex scale = 0.25 / (s * s);
  if (h >= mi + mj) {
    const Complex a = expm1_of(-x_ * mi);
    const Complex b = expm1_of(-x_ * mj);
    return -scale * std::exp(-x_ * (h - mi - mj)) * a * a * b * b / (4.0 * mi * mj);
  }
  // haar_cross_of sums plain numbers: real and imaginary part one after the other.
  const auto both = [&](const auto& k) {
    return Complex(haar_cross_of(mi, mj, h, [&k](double lag) { return k(std::fabs(lag)).real(); }),
                   haar_cross_of(mi, mj, h, [&k](double lag) { return k(std::fabs(lag)).imag(); }));
  };
  if (std::abs(x_) * (h + mi + mj) > 1.0) {
    const Complex sinh_x = sinh_of(x_);
    return scale * both([&](double distance) {
             return (fall_ * distance < 60.0 ? std::exp(-x_ * distance) : Complex()) + distance * sinh_x;
           });
  }
  const Complex a = 2.0 * sinh_of(0.5 * x_ * mi);
  const Complex b = 2.0 * sinh_of(0.5 * x_ * mj);
  const Complex even = -std::cosh(x_ * h) * a * a * b * b / (4.0 * mi * mj);
  const Complex rest = sinh_minus(x_);
  return scale * (even + both([&](double distance) { return distance * rest - sinh_minus(x_ * distance); }));
}

void DampedOscillation::add_haar_cross(double mi, double mj, std::span<const double> lags, double factor,
                                       std::span<double> out) const {
  for (std::size_t i = 0; i < lags.size(); ++i) {
    const double h = lags[i];
    if (fall_ <= kWhite) {
      if (fall_ * (h - mi - mj) < 200.0) {
        out[i] += factor * (weight_ * haar_cross(mi, mj, h)).real();
      }
    } else if (h < mi + mj) {
      out[i] += factor * haar_cross_of(mi, mj, h, [](double lag) { return 0.5 * std::fabs(lag); });
    }
  }
}

Ringing DampedOscillation::ringing() const {
  const double length = 2.5 / std::max({std::fabs(x_.imag()), fall_, 1e-9});
  return {std::min(10.0 / fall_, 256.0 * length), length};
}

StateSpace DampedOscillation::state_space(double square) const {
  const double cosine = std::cos(turn_);
  const double sine = std::sin(turn_);
  const double decay = std::exp(-fall_);
  StateSpace model;
  model.phi.resize(2, 2);
  model.phi << cosine + weight_.imag() * sine, sine / root_, -sine / root_, cosine - weight_.imag() * sine;
  model.phi *= decay;
  model.cov0 = square * Eigen::MatrixXd::Identity(2, 2);
  if (rate_ > 1.0) {
    model.q = model.cov0 - square * model.phi * model.phi.transpose();
  } else {
    // 4 zeta w int_0^1 g g' ds with g the response to a kick, of which I - phi phi' is the small difference.
    model.q = Eigen::MatrixXd::Zero(2, 2);
    for (std::size_t k = 0; k < kNode.size(); ++k) {
      for (const double sign : {-1.0, 1.0}) {
        const double at = 0.5 * (1.0 + sign * kNode[k]);
        const double sine_at = std::sin(turn_ * at);
        const Eigen::Vector2d kick(sine_at / root_, std::cos(turn_ * at) - weight_.imag() * sine_at);
        model.q += 2.0 * fall_ * kNodeWeight[k] * square * std::exp(-2.0 * fall_ * at) * kick * kick.transpose();
      }
    }
  }
  model.h = Eigen::RowVectorXd::Unit(2, 0);
  model.mean0 = Eigen::VectorXd::Zero(2);
  return model;
}

void DampedOscillation::add_path(double sigma, Random& random, std::span<double> out) const {
  const StateSpace model = state_space(sigma * sigma);
  const double first = std::sqrt(model.q(0, 0));
  const double shared = first > 0.0 ? model.q(1, 0) / first : 0.0;
  const double second = std::sqrt(std::max(0.0, model.q(1, 1) - shared * shared));
  double position = sigma * random.normal();
  double velocity = sigma * random.normal();
  for (double& value : out) {
    value += position;
    const double kick = random.normal();
    const double before = position;
    position = model.phi(0, 0) * before + model.phi(0, 1) * velocity + first * kick;
    velocity = model.phi(1, 0) * before + model.phi(1, 1) * velocity + shared * kick + second * random.normal();
  }
}

}  // namespace driftlab
