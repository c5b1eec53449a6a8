/// The laws of the second-order process against 100-digit arithmetic, where the plain forms cancel.
#include "core/process/damped_oscillation.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

using Exact = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>>;

/// e^-x|h| with x = a + ib: numbers (re, im), for the few operations that the textbook form needs.
struct Pair {
  Exact re, im;
  friend Pair operator*(const Pair& a, const Pair& b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
  friend Pair operator/(const Pair& a, const Pair& b) {
    const Exact size = b.re * b.re + b.im * b.im;
    return {(a.re * b.re + a.im * b.im) / size, (a.im * b.re - a.re * b.im) / size};
  }
  friend Pair operator+(const Pair& a, const Pair& b) { return {a.re + b.re, a.im + b.im}; }
  friend Pair operator-(const Pair& a, const Pair& b) { return {a.re - b.re, a.im - b.im}; }
};

Pair real(const Exact& value) { return {value, 0}; }

struct ExactProcess {
  Exact a, b;
  Pair weight;

  ExactProcess(double rate, double quality) {
    const Exact zeta = Exact(0.5) / Exact(quality);
    const Exact root = sqrt(1 - zeta * zeta);
    a = zeta * rate;
    b = root * rate;
    weight = {1, zeta / root};
  }
  [[nodiscard]] Pair power(const Exact& h) const { return {exp(-a * h) * cos(b * h), -exp(-a * h) * sin(b * h)}; }
  /// As of GaussMarkov in closed_forms_test.cpp, with a complex phi.
  [[nodiscard]] double haar_variance(double m_value) const {
    const Exact m = m_value;
    const Pair phi = power(1);
    const Pair gap = real(1) - phi;
    const Pair rest = real(1) - power(m);
    const Pair box = real(m) * (real(1) + phi) / gap - real(2) * phi * rest / (gap * gap);
    const Pair cross = phi * rest * rest / (gap * gap);
    return static_cast<double>((weight * (box - cross) / real(2 * m * m)).re);
  }
  [[nodiscard]] double variogram(double h) const { return static_cast<double>(2 - 2 * (weight * power(h)).re); }
  [[nodiscard]] double density(double f) const {
    const Pair phi = power(1);
    const Exact cosine = cos(2 * boost::math::constants::pi<Exact>() * Exact(f));
    const Pair sum = (real(1) - phi * phi) / (real(1) - real(2 * cosine) * phi + phi * phi);
    return static_cast<double>((weight * sum).re);
  }
};

TEST(DampedOscillation, KeepsItsDigitsFromSlowToFoldedAndFromBroadToSharp) {
  for (const double rate : {1e-7, 1e-5, 1e-3, 0.05, 0.3, 1.0, 2.0, 3.5, 9.0}) {
    for (const double quality : {0.51, std::numbers::sqrt2 / 2.0, 2.0, 30.0, 1e4}) {
      const DampedOscillation process(rate, quality);
      const ExactProcess exact(rate, quality);
      for (const double m : {1.0, 2.0, 7.0, 64.0, 4096.0, 1048576.0}) {
        // The first-order terms of both exponentials cancel, which costs 1/(w m) times the rounding.
        const double expected = exact.haar_variance(m);
        EXPECT_NEAR(process.haar_variance(m), expected, (1e-9 + 3e-15 / (rate * m)) * expected)
            << rate << " " << quality << " " << m;
      }
      for (const double h : {1.0, 3.0, 100.0}) {
        const double expected = exact.variogram(h);
        EXPECT_NEAR(process.variogram(h), expected, 1e-8 * expected) << rate << " " << quality << " " << h;
      }
      for (const double f : {0.0, 1e-6, 1e-3, 0.1, 0.5}) {
        const double expected = exact.density(f);
        EXPECT_NEAR(process.density(f), expected, 1e-9 * expected) << rate << " " << quality << " " << f;
      }
      EXPECT_NEAR(process.density_at_zero(), exact.density(0.0), 1e-9 * exact.density(0.0)) << rate << " " << quality;
    }
  }
}

TEST(DampedOscillation, StepNoiseIsPositiveHoweverSlow) {
  for (const double rate : {1e-7, 1e-4, 0.01, 0.99, 1.01, 3.0, 40.0}) {
    for (const double quality : {0.51, 3.0, 1e4}) {
      const StateSpace model = DampedOscillation(rate, quality).state_space(2.0);
      EXPECT_GT(model.q(0, 0), 0.0) << rate << " " << quality;
      EXPECT_GT(model.q(0, 0) * model.q(1, 1), model.q(0, 1) * model.q(0, 1)) << rate << " " << quality;
      const Eigen::MatrixXd next = model.phi * model.cov0 * model.phi.transpose() + model.q;
      EXPECT_TRUE(next.isApprox(model.cov0, 1e-14)) << rate << " " << quality;
    }
  }
}

}  // namespace
}  // namespace driftlab
