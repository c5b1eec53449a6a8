/// Rounding a rate was taken for the quantization noise Q of IEEE Std 952, which is what a rounded angle leaves: the
/// error of a rounded rate is white.
#include "core/process/quantization_noise.hpp"
#include "core/process/white_noise.hpp"
#include "core/variance/haar_variance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;
constexpr double kStep = 1.5;
constexpr std::size_t kSamples = 1U << 17U;

/// The error of rounding what has the standard deviation 1: its characteristic function makes the error uniform and
/// white to exp(-2 pi^2/1.5^2) = 1.5e-4.
std::vector<double> rounded_minus(const std::vector<double>& x) {
  std::vector<double> error(x.size());
  for (std::size_t t = 0; t < x.size(); ++t) {
    error[t] = kStep * std::nearbyint(x[t] / kStep) - x[t];
  }
  return error;
}

std::vector<double> noise(std::size_t samples) {
  Random random(15, 5);
  std::vector<double> x(samples);
  for (double& value : x) {
    value = random.normal();
  }
  return x;
}

TEST(Rounding, OfARateLeavesAWhiteFloorOfATwelfthOfTheSquaredStep) {
  const WhiteNoise floor{kStep * std::sqrt(kDt / 12.0)};
  const HaarVariance curve = haar_variance(rounded_minus(noise(kSamples)), 0.0);
  for (std::size_t j = 0; j < 10; ++j) {
    // edf is at least samples/(4 m) in white noise; five standard deviations.
    const double m = std::ldexp(1.0, static_cast<int>(j));
    const double tolerance = 5.0 * std::sqrt(8.0 * m / kSamples);
    EXPECT_NEAR(curve.variance[j] / floor.haar_variance(m, kDt), 1.0, tolerance) << m;
  }
}

TEST(Rounding, OfAnAngleLeavesQuantizationNoise) {
  std::vector<double> angle = noise(kSamples + 1);
  const std::vector<double> error = rounded_minus(angle);
  std::vector<double> rate(kSamples);
  for (std::size_t t = 0; t < kSamples; ++t) {
    rate[t] = (error[t + 1] - error[t]) / kDt;
  }
  const QuantizationNoise law{kStep / std::sqrt(12.0)};
  const HaarVariance curve = haar_variance(rate, 0.0);
  for (std::size_t j = 0; j < 10; ++j) {
    const double m = std::ldexp(1.0, static_cast<int>(j));
    const double tolerance = 5.0 * std::sqrt(8.0 * m / kSamples);
    EXPECT_NEAR(curve.variance[j] / law.haar_variance(m, kDt), 1.0, tolerance) << m;
  }
}

}  // namespace
}  // namespace driftlab
