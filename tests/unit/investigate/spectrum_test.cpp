#include "core/investigate/fullrate/spectrum.hpp"

#include "core/process/flicker_noise.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/registry.hpp"
#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

namespace driftlab::investigate {
namespace {

constexpr double kPi = std::numbers::pi;

bool even_and_of_factors_2_3_5(std::size_t n) {
  if (n % 2 != 0) {
    return false;
  }
  for (const std::size_t factor : {2U, 3U, 5U}) {
    while (n % factor == 0) {
      n /= factor;
    }
  }
  return n == 1;
}

TEST(Spectrum, TheFastLengthIsTheLargestOfItsKind) {
  std::size_t largest = 2;
  for (std::size_t n = 2; n < 3000; ++n) {
    largest = even_and_of_factors_2_3_5(n) ? n : largest;
    ASSERT_EQ(fast_length(n), largest) << n;
  }
}

TEST(Spectrum, TheTransformIsTheSumOfItsDefinition) {
  const std::vector<double> values = white(48, 1);
  for (const std::size_t length : {std::size_t{0}, std::size_t{64}}) {
    const auto found = half_spectrum_of(values, length);
    const auto n = static_cast<double>(length == 0 ? values.size() : length);
    ASSERT_EQ(found.size(), static_cast<std::size_t>(n) / 2 + 1);
    for (std::size_t k = 0; k < found.size(); ++k) {
      std::complex<double> sum;
      for (std::size_t t = 0; t < values.size(); ++t) {
        sum += values[t] * std::polar(1.0, -2.0 * kPi * static_cast<double>(k) * static_cast<double>(t) / n);
      }
      EXPECT_LT(std::abs(found[k] - sum), 1e-12) << k;  // 48 terms of size 1: 48^2 roundings of 1e-16
    }
  }
}

TEST(Spectrum, WhiteNoiseHasDensityVarianceTimesIntervalWithTheScatterOfItsWeights) {
  // Ordinates over density are exponential, so K of them have a mean of 1 +- 1/sqrt(K); a bin of m is Gamma(m)/m, for
  // which m (x - 1)^2 has mean 1 and variance 2 + 6/m.
  constexpr double kDt = 0.01;
  constexpr double kSigma = 3.0;
  std::vector<double> values = white(60000, 2);
  for (double& value : values) {
    value = 7.0 + kSigma * value;
  }
  const Spectrum s = estimate_spectrum(values, kDt, 0.3);
  double ordinates = 0.0;
  double mean = 0.0;
  double scatter = 0.0;
  double variance = 0.0;
  for (std::size_t j = 0; j < s.power.size(); ++j) {
    const double x = s.power[j] / (kSigma * kSigma * kDt);
    ordinates += s.weight[j];
    mean += s.weight[j] * x;
    scatter += s.weight[j] * (x - 1.0) * (x - 1.0);
    variance += 2.0 + 6.0 / s.weight[j];
  }
  EXPECT_NEAR(mean / ordinates, 1.0, 4.0 / std::sqrt(ordinates));
  EXPECT_NEAR(scatter, static_cast<double>(s.power.size()), 4.0 * std::sqrt(variance));
}

TEST(Spectrum, EveryFrequencyFromTheLowestToNyquistIsInOneBin) {
  constexpr double kDt = 0.01;
  const Spectrum s = estimate_spectrum(white(5000, 3), kDt, 0.5);
  const double df = 1.0 / (5000.0 * kDt);
  EXPECT_EQ(s.samples, 5000U);
  EXPECT_DOUBLE_EQ(s.f_hz.front(), 25.0 * df);  // 0.5 Hz is ordinate 25
  double next = 25.0;
  for (std::size_t j = 0; j < s.weight.size(); ++j) {
    EXPECT_NEAR(s.f_hz[j], (next + 0.5 * (s.weight[j] - 1.0)) * df, 1e-9);
    EXPECT_LE(s.weight[j], std::max(1.0, 0.025 * next));
    next += s.weight[j];
  }
  EXPECT_EQ(next, 2500.0) << "up to, not including, the Nyquist frequency";
}

TEST(Spectrum, ASinusoidStandsInItsBinWithAQuarterOfItsSquareTimesTheLength) {
  // |sum A sin(w t) exp(-i w t)| = A n/2 at a Fourier frequency, so P = dt/n (A n/2)^2; the constant is taken out.
  constexpr double kDt = 0.02;
  constexpr double kAmplitude = 0.4;
  std::vector<double> values(2000);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = 100.0 + kAmplitude * std::sin(2.0 * kPi * 30.0 * static_cast<double>(i) / 2000.0 + 0.3);
  }
  const Spectrum s = estimate_spectrum(values, kDt, 0.3);
  const auto top = std::max_element(s.power.begin(), s.power.end());
  EXPECT_NEAR(s.f_hz[static_cast<std::size_t>(top - s.power.begin())], 30.0 / (2000.0 * kDt), 1e-12);
  EXPECT_NEAR(*top, 0.25 * kAmplitude * kAmplitude * 2000.0 * kDt, 1e-9);
  EXPECT_LT(std::accumulate(s.power.begin(), s.power.end(), -*top), 1e-9);
}

/// E |sum_t e_t exp(-i w t)|^2 dt/n for a process of this covariance.
template <class Covariance>
double expected_periodogram(std::size_t n, double f_hz, double dt_s, const Covariance& covariance) {
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const double lag = static_cast<double>(i) - static_cast<double>(j);
      sum += covariance(i, j) * std::cos(2.0 * kPi * f_hz * dt_s * lag);
    }
  }
  return sum * dt_s / static_cast<double>(n);
}

TEST(Spectrum, SlowProcessesShowTheExpectedPeriodogramOfTheirFiniteRecord) {
  constexpr std::size_t kCount = 96;
  constexpr double kDt = 0.1;
  const SlowComponent markov = slow_component(registered<GaussMarkov>(), 2.0, 0.4);
  const SlowComponent walk = slow_component(registered<RandomWalk>(), 0.3);
  for (const std::size_t k : {1U, 2U, 7U, 31U, 47U}) {
    const double f = static_cast<double>(k) / (static_cast<double>(kCount) * kDt);
    const auto found = [&](const SlowComponent& component) {
      SlowModel model;
      model.components = {component};
      return slow_density(model, 0, f, kDt, kCount);
    };
    const double of_markov = expected_periodogram(kCount, f, kDt, [&](std::size_t i, std::size_t j) {
      return 2.0 * std::exp(-0.4 * kDt * std::fabs(static_cast<double>(i) - static_cast<double>(j)));
    });
    EXPECT_NEAR(found(markov), of_markov, 1e-10 * of_markov) << k;
    const double of_walk = expected_periodogram(kCount, f, kDt, [&](std::size_t i, std::size_t j) {
      return 0.3 * kDt * static_cast<double>(std::min(i, j) + 1);
    });
    // The double sum cancels from n^2 terms of size n: eps n^3 against a result that falls with k^2.
    EXPECT_NEAR(found(walk), of_walk, 1e-9 * of_walk) << k;
  }
}

TEST(Spectrum, AComponentOfOneRecordingIsInTheDensityOfThatOneOnly) {
  SlowModel model;
  model.components = {slow_component(registered<GaussMarkov>(), 1.0, 0.5, {0, 1}),
                      slow_component(registered<FlickerNoise>(), 3.0)};
  const double flicker = 3.0 / (2.0 * kPi * 0.7);
  EXPECT_DOUBLE_EQ(slow_density(model, 0, 0.7, 0.02, 1000.0), flicker);
  EXPECT_GT(slow_density(model, 1, 0.7, 0.02, 1000.0), 1.01 * flicker);
}

TEST(Spectrum, TheLowPassIsTheBilinearFilterOfSecondOrder) {
  // Coefficients of the same filter as difference equation (Oppenheim and Schafer, bilinear transformation of
  // 1/(s^2 + sqrt(2) s + 1) with the corner in its place), squared gain on the unit circle.
  constexpr double kDt = 0.01;
  constexpr double kCorner = 12.0;
  const double g = std::tan(kPi * kCorner * kDt);
  const double a0 = 1.0 + std::numbers::sqrt2 * g + g * g;
  const double a1 = 2.0 * (g * g - 1.0);
  const double a2 = 1.0 - std::numbers::sqrt2 * g + g * g;
  for (const double f : {0.1, 3.0, 12.0, 30.0, 49.0}) {
    const std::complex<double> z = std::polar(1.0, -2.0 * kPi * f * kDt);
    const double gain = std::norm(g * g * (1.0 + 2.0 * z + z * z) / (a0 + a1 * z + a2 * z * z));
    EXPECT_NEAR(butterworth_gain(f, kCorner, kDt), gain, 1e-12) << f;
  }
  EXPECT_DOUBLE_EQ(butterworth_gain(kCorner, kCorner, kDt), 0.5);
}

TEST(Spectrum, QuantizationNoiseIsTheDifferenceOfWhiteNoiseOverTheInterval) {
  // e_t = (q_t - q_{t-1})/dt with q white of variance 1 has variance 2/dt^2: twice the integral of the density.
  constexpr double kDt = 0.02;
  constexpr int kSteps = 2000;
  double integral = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    integral += quantization_shape((i + 0.5) / kSteps * 0.5 / kDt, kDt) * 0.5 / kDt / kSteps;
  }
  EXPECT_NEAR(2.0 * integral, 2.0 / (kDt * kDt), 1e-6 / (kDt * kDt));
  EXPECT_NEAR(quantization_shape(0.1, kDt), std::pow(2.0 * kPi * 0.1, 2) * kDt, 1e-4 * 0.01);  // small: (2 pi f)^2 dt
}

}  // namespace
}  // namespace driftlab::investigate
