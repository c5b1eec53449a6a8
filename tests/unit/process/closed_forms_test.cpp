// The closed forms against 100-digit arithmetic and against independent exact tables: 1e-10 is promised, 1e-13 is met.
#include "core/process/flicker_noise.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/linear_drift.hpp"
#include "core/process/model.hpp"
#include "core/process/quantization_noise.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/sinusoid.hpp"
#include "core/process/white_noise.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

using Exact = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>>;

/// The textbook form of an AR(1), which cancels, in 100 digits: nu = g [m (1 - phi^2) - ... ] written with phi alone:
/// Var(sum of the newer m - sum of the older m)/(4 m^2) = (2 S_mm - 2 C)/(4 m^2), S_mm the variance of a box sum, C the
/// covariance of neighbouring box sums.
Exact exact_gauss_markov(double x_value, double m_value) {
  const Exact x = x_value;
  const Exact m = m_value;
  const Exact phi = exp(-x);
  const Exact gap = 1 - phi;
  const Exact power = exp(-x * m);
  const Exact box = m * (1 + phi) / gap - 2 * phi * (1 - power) / (gap * gap);
  const Exact cross = phi * (1 - power) * (1 - power) / (gap * gap);
  return (box - cross) / (2 * m * m);
}

TEST(ClosedForms, GaussMarkovKeepsThirteenDigitsAsPhiTendsToOne) {
  double worst = 0.0;
  for (const double x :
       {1e-14, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3, 0.01, 0.1, 0.3, 0.499, 0.5, 0.501, 1.0, 3.0, 10.0, 39.9, 41.0}) {
    for (int power = 0; power <= 29; ++power) {
      const double m = std::ldexp(1.0, power);
      const double value = GaussMarkov{1.0, x}.haar_variance(m, 1.0);
      const double error = std::fabs(static_cast<double>(Exact(value) / exact_gauss_markov(x, m) - 1));
      worst = std::max(worst, error);
      EXPECT_LT(error, 1e-13) << "x=" << x << " m=" << m;
    }
  }
  RecordProperty("worst_relative_error", std::to_string(worst));
}

TEST(ClosedForms, FlickerNoiseMatchesTheSumOverItsVariogram) {
  // nu = -1/2 sum_lag pairs(lag) V(lag) with pairs the correlation of the filter (+1/2m)^m (-1/2m)^m, in long double;
  // the variogram is tabulated or asymptotic, the variance an expansion whose form changes at m = 64.
  const FlickerNoise flicker{1.0};
  for (const int m : {1, 2, 3, 16, 63, 64, 65, 128, 1000, 4096}) {
    long double sum = 0.0L;
    for (int lag = 1; lag < 2 * m; ++lag) {
      // Pairs `lag` apart: same half 2 (m - lag)+, other half min(lag, 2m - lag).
      const long double same = 2.0L * std::max(m - lag, 0);
      const long double other = std::min(lag, 2 * m - lag);
      sum -= (same - other) * static_cast<long double>(flicker.variogram(lag, 1.0));
    }
    const double expected = static_cast<double>(sum / (4.0L * m * m));
    // The sum cancels from V ~ ln m / m^2 terms: some 1e-15 ln(m) of V remains.
    EXPECT_NEAR(flicker.haar_variance(m, 1.0), expected, 1e-12 * expected) << m;
  }
}

TEST(ClosedForms, FlickerFloorIsTheTextbookOne) {
  EXPECT_NEAR(std::sqrt(2.0 * FlickerNoise{1.0}.haar_variance(0x1p29, 1.0)), std::sqrt(2.0 * std::log(2.0) / M_PI),
              1e-12);
}

TEST(ClosedForms, SinusoidKeepsItsPhaseAtScaleTwoToTheThirty) {
  const double f = 0.1234567890123;
  const Exact& pi = boost::math::constants::pi<Exact>();
  for (const double m : {1.0, 1024.0, 0x1p20 + 3.0, 0x1p29}) {
    const Exact wide = sin(pi * Exact(f) * Exact(m));
    const Exact narrow = sin(pi * Exact(f));
    const Exact expected = wide * wide * wide * wide / (2 * Exact(m) * Exact(m) * narrow * narrow);
    EXPECT_NEAR(Sinusoid({1.0, f}).haar_variance(m, 1.0), static_cast<double>(expected),
                1e-10 * static_cast<double>(expected));
  }
}

TEST(ClosedForms, AllanConventionsAreThoseOfTheStandard) {
  constexpr double kDt = 0.005;
  const double m = 64.0;
  const double tau = m * kDt;
  const auto allan = [&](const char* name, double level) {
    return make_process(name, {level})->allan_variance(m, kDt);
  };
  EXPECT_NEAR(allan("white_noise", 0.3), 0.09 / tau, 1e-15);
  EXPECT_NEAR(allan("quantization_noise", 0.3), 3.0 * 0.09 / (tau * tau), 1e-12);
  EXPECT_NEAR(allan("random_walk", 0.3), 0.09 * tau / 3.0, 0.09 * tau / 3.0 / (m * m)) << "sampled: (2m^2+1)/(2m^2)";
  EXPECT_NEAR(allan("linear_drift", 0.3), 0.5 * 0.09 * tau * tau, 1e-15);
}

}  // namespace
}  // namespace driftlab
