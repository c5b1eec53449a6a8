/// Band-limited white noise under its other names, and power laws against 100-digit arithmetic.
#include "core/process/decimation.hpp"
#include "core/process/flicker_noise.hpp"
#include "core/process/low_pass_1.hpp"
#include "core/process/low_pass_2.hpp"
#include "core/process/moving_average.hpp"
#include "core/process/power_law.hpp"
#include "core/process/resonance.hpp"
#include "core/process/white_noise.hpp"

#include <boost/math/special_functions/gamma.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

TEST(BandLimited, FirstOrderLowPassIsAGaussMarkovProcessOfThatCorner) {
  const LowPass1 filtered{0.3, 7.0};
  const double beta = 2.0 * std::numbers::pi * 7.0;
  const GaussMarkov same{0.3 * std::sqrt(std::tanh(0.5 * beta * kDt) / kDt), beta};
  for (const double m : {1.0, 10.0, 1e6}) {
    EXPECT_DOUBLE_EQ(filtered.haar_variance(m, kDt), same.haar_variance(m, kDt));
  }
  EXPECT_NEAR(same.low_frequency(kDt).density, 0.3 * 0.3, 1e-15);
}

TEST(BandLimited, SecondOrderLowPassIsAResonanceOfQualityRootHalf) {
  const LowPass2 filtered{0.3, 7.0};
  const Resonance same{std::sqrt(filtered.sample_variance(kDt)), 7.0, std::numbers::sqrt2 / 2.0};
  for (const double m : {1.0, 10.0, 1e6}) {
    EXPECT_DOUBLE_EQ(filtered.haar_variance(m, kDt), same.haar_variance(m, kDt));
  }
  // The analogue filter's density, with the two nearest pairs of aliases; the others are below 1e-6 of it.
  for (const double f : {0.5, 7.0, 20.0}) {
    double sum = 0.0;
    double zero = 0.0;
    for (int k = -30; k <= 30; ++k) {
      sum += 1.0 / (1.0 + std::pow((f + k / kDt) / 7.0, 4));
      zero += 1.0 / (1.0 + std::pow(k / kDt / 7.0, 4));
    }
    EXPECT_NEAR(*filtered.spectral_density(f, kDt), 0.09 * sum / zero, 1e-7 * sum) << f;
  }
}

TEST(BandLimited, ACornerOrWidthBeyondTheSamplesLeavesWhiteNoise) {
  const WhiteNoise white{0.3};
  for (const double m : {1.0, 3.0, 512.0}) {
    const double expected = white.haar_variance(m, kDt);
    EXPECT_NEAR((LowPass1{0.3, 700.0}.haar_variance(m, kDt)), expected, 1e-12 * expected);
    EXPECT_NEAR((LowPass2{0.3, 900.0}.haar_variance(m, kDt)), expected, 1e-12 * expected);
    EXPECT_NEAR((MovingAverage{0.3, 1.0}.haar_variance(m, kDt)), expected, 1e-12 * expected);
    EXPECT_NEAR((Decimation{0.3, 1.0 / 3.0}.haar_variance(m, kDt)), expected, 1e-12 * expected);
  }
}

/// A driver that averages thirteen readings and gives every fourth: the sum over readings, in the readings' own
/// samples.
TEST(BandLimited, AnAverageOfReadingsThatIsThinnedIsAMovingAverageOfAFractionOfSamples) {
  const MovingAverage thinned{0.3, 13.0 / 4.0};
  const MovingAverage readings{0.3, 13.0};
  for (const double lag : {0.0, 1.0, 2.0, 3.0, 4.0}) {
    // Equal up to the level: aliases of the slower sampling are part of its N.
    EXPECT_NEAR(*thinned.autocovariance(lag, kDt) / *thinned.autocovariance(0.0, kDt),
                *readings.autocovariance(4.0 * lag, kDt / 4.0) / *readings.autocovariance(0.0, kDt / 4.0), 1e-14);
  }
}

TEST(BandLimited, DecimationIsThreeAveragesInARow) {
  // Sums over 200 points a sample of three boxes of 1.5 samples each.
  constexpr int kPoints = 200;
  constexpr int kBox = 300;
  std::vector<double> kernel{1.0};
  for (int stage = 0; stage < 3; ++stage) {
    std::vector<double> longer(kernel.size() + kBox - 1, 0.0);
    for (std::size_t i = 0; i < kernel.size(); ++i) {
      for (int j = 0; j < kBox; ++j) {
        longer[i + static_cast<std::size_t>(j)] += kernel[i] / kBox;
      }
    }
    kernel = std::move(longer);
  }
  const auto product = [&](std::size_t shift) {
    double sum = 0.0;
    for (std::size_t i = 0; i + shift < kernel.size(); ++i) {
      sum += kernel[i] * kernel[i + shift];
    }
    return sum;
  };
  const Decimation process{0.3, 1.5};
  for (std::size_t lag = 1; lag < 5; ++lag) {
    // The grid errs by 1/(4 x 300^2).
    EXPECT_NEAR(*process.autocovariance(static_cast<double>(lag), kDt) / *process.autocovariance(0.0, kDt),
                product(lag * kPoints) / product(0), 1e-5)
        << lag;
  }
}

using Exact = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>>;

/// Gamma(1 - 2D) Gamma(h + D)/(Gamma(D) Gamma(1 - D) Gamma(h + 1 - D)), D = alpha/2 + 1: whatever polynomial it holds
/// beside, second differences of second differences lose it.
Exact exact_power_law(double alpha, double m) {
  const Exact d = Exact(alpha) / 2 + 1;
  const auto gamma = [&](double h) {
    Exact ratio = tgamma(1 - 2 * d) / (tgamma(1 - d) * tgamma(1 - d));
    for (double k = 0.0; k < h; k += 1.0) {
      ratio *= (k + d) / (k + 1 - d);
    }
    return ratio;
  };
  return (2 * gamma(2.0 * m) - 8 * gamma(m) + 6 * gamma(0.0)) / (4 * Exact(m) * Exact(m));
}

TEST(PowerLaw, KeepsTwelveDigitsThroughTheFlickerExponent) {
  for (const double alpha : {0.2, 0.7, 0.999, 1.0 - 1e-7, 1.0 + 1e-11, 1.01, 1.5, 1.9}) {
    for (const double m : {1.0, 2.0, 9.0, 100.0, 4096.0}) {
      const PowerLaw process{1.0, alpha};
      const double expected =
          static_cast<double>(exact_power_law(alpha, m)) * std::pow(2.0 * std::numbers::pi * kDt, alpha - 1.0);
      EXPECT_NEAR(process.haar_variance(m, kDt), expected, 1e-12 * expected) << alpha << " " << m;
    }
  }
}

TEST(PowerLaw, OfExponentOneHasTheLongScalesOfFlickerNoise) {
  // Below a hundredth of the sampling rate sin x is x to 2e-4.
  const PowerLaw law{0.7, 1.0};
  const FlickerNoise flicker{0.7};
  for (const double m : {64.0, 1024.0, 65536.0}) {
    const double expected = flicker.haar_variance(m, kDt);
    EXPECT_NEAR(law.haar_variance(m, kDt), expected, 1e-3 * expected) << m;
  }
}

}  // namespace
}  // namespace driftlab
