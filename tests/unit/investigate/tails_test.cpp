#include "core/investigate/fullrate/tails.hpp"

#include "core/process/distributions.hpp"
#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab::investigate {
namespace {

/// Student's t of unit variance times `scale`.
std::vector<double> student_noise(std::size_t count, double nu, double scale, std::uint64_t seed,
                                  std::uint64_t stream) {
  Random random(seed, stream);
  std::vector<double> values(count);
  for (double& value : values) {
    value = scale * random.student(nu) * std::sqrt((nu - 2.0) / nu);
  }
  return values;
}

/// Standard normal, of which a fraction is shifted by `magnitude` to either side.
std::vector<double> with_outliers(std::size_t count, double fraction, double magnitude, std::uint64_t stream) {
  Random random(23, stream);
  std::vector<double> values(count);
  for (double& value : values) {
    value = random.normal();
    if (random.uniform() < fraction) {
      value += random.uniform() < 0.5 ? -magnitude : magnitude;
    }
  }
  return values;
}

InnovationHistogram histogram(std::vector<double> values) {
  const NoiseAtFullRate noise({std::move(values)});
  return histogram_of(noise.data, false);
}

double log_normal_density(double e, double variance) {
  return -0.5 * (std::log(2.0 * std::numbers::pi * variance) + e * e / variance);
}

double log_student_density(double e, double nu) {
  const double s2 = nu - 2.0;
  return log_gamma(0.5 * (nu + 1.0)) - log_gamma(0.5 * nu) - 0.5 * std::log(std::numbers::pi * s2) -
         0.5 * (nu + 1.0) * std::log1p(e * e / s2);
}

TEST(Tails, AHistogramKeepsCountAndSquaresOfTheSamplesInUse) {
  NoiseAtFullRate noise({{0.01, -0.02, 3.0, -15.0, 4000.0, 2.0}});
  noise.data.used[0][5] = 0;
  const InnovationHistogram h = histogram_of(noise.data, false);
  EXPECT_EQ(h.samples, 5.0);
  EXPECT_DOUBLE_EQ(h.square, 0.0001 + 0.0004 + 9.0 + 225.0 + 1e6) << "what is beyond 1000 counts as 1000";
  double count = 0.0;
  double square = 0.0;
  for (std::size_t j = 0; j < h.centre.size(); ++j) {
    count += h.count[j];
    square += h.count[j] * h.centre[j] * h.centre[j];
  }
  EXPECT_EQ(count, 5.0);
  EXPECT_DOUBLE_EQ(square, h.square);
  EXPECT_EQ(h.count[0], 2.0) << "0.01 and 0.02 share a bin, whatever their sign";
}

TEST(Tails, GainsAreLogLikelihoodRatiosOfTheSamplesThemselves) {
  // Binning moves a sample's log density, as a function of x = e^2, by at most |g''|/2 times the variance of x in a
  // bin, (2 e w)^2/12: for the t (nu + 1) w^2/(48 (nu - 2)) at most, summed over the samples.
  constexpr double kNu = 5.0;
  constexpr std::size_t kCount = 20000;
  const std::vector<double> values = student_noise(kCount, kNu, 1.0, 29, 0);
  double t = 0.0;
  double gauss = 0.0;
  double square = 0.0;
  for (const double e : values) {
    t += log_student_density(e, kNu);
    gauss += log_normal_density(e, 1.0);
    square += e * e / kCount;
  }
  double free_gauss = 0.0;
  for (const double e : values) {
    free_gauss += log_normal_density(e, square);
  }
  const double binning = kCount * (kNu + 1.0) * 0.05 * 0.05 / (48.0 * (kNu - 2.0));
  const InnovationHistogram h = histogram(values);
  EXPECT_NEAR(student_gain(h, 1.0 / kNu, true), t - gauss, binning);
  EXPECT_GT(t - free_gauss, 10.0 * binning);  // there is something to see
  EXPECT_GE(student_gain(h, 1.0 / kNu, false), t - free_gauss - binning) << "a free scale gains at least as much";
}

TEST(Tails, IntervalsOfTheTailHoldTheTruth) {
  // 95 of 100 intervals, 88 at least: 95 less 3.2 standard deviations of a binomial count.
  for (const bool known : {true, false}) {
    int covered = 0;
    for (std::uint64_t i = 0; i < 100; ++i) {
      const TailFit fit = fit_student(histogram(student_noise(4000, 6.0, known ? 1.0 : 1.3, 31, i)), known);
      covered += fit.interval.low <= 1.0 / 6.0 && 1.0 / 6.0 <= fit.interval.high ? 1 : 0;
      EXPECT_LT(fit.interval.low, fit.value);
      EXPECT_GT(fit.interval.high, fit.value);
      EXPECT_GT(fit.gain, 20.0);
    }
    EXPECT_GE(covered, 88) << (known ? "known scale" : "free scale");
  }
}

TEST(Tails, GaussianNoiseHasNoTails) {
  // 1/nu stands at its bound for half of the samples and gains a chi-square of one degree of freedom for the others:
  // 3.84 is exceeded in 2.5 % of cases, at most 14 of 200 (5 + 4 sqrt(5)).
  int seen = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    seen += fit_student(histogram(white(4000, 37, i)), false).gain > 3.84 ? 1 : 0;
  }
  EXPECT_LE(seen, 14);
}

TEST(Tails, TooFewSamplesSayNothing) {
  EXPECT_EQ(fit_student(histogram(student_noise(499, 3.0, 1.0, 41, 0)), true).gain, 0.0);
  EXPECT_EQ(fit_mixture(histogram(with_outliers(499, 0.05, 20.0, 0)), true).gain, 0.0);
}

TEST(Tails, IntervalsOfGrossErrorsHoldTheTruth) {
  constexpr double kFraction = 0.003;
  constexpr double kMagnitude = 8.0;
  constexpr std::size_t kCount = 20000;
  int fractions = 0;
  int magnitudes = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const MixtureFit fit = fit_mixture(histogram(with_outliers(kCount, kFraction, kMagnitude, i)), true);
    fractions += fit.fraction_interval.low <= kFraction && kFraction <= fit.fraction_interval.high ? 1 : 0;
    magnitudes += fit.magnitude_interval.low <= kMagnitude && kMagnitude <= fit.magnitude_interval.high ? 1 : 0;
    // 60 outliers: each knows the magnitude to 1, all of them to 1/sqrt(60).
    EXPECT_NEAR(fit.magnitude, kMagnitude, 4.5 / std::sqrt(kFraction * kCount));
  }
  EXPECT_GE(fractions, 51);  // 57 expected, less 3.5 standard deviations of 1.7
  EXPECT_GE(magnitudes, 51);
}

TEST(Tails, TheScaleOfABodyWithGrossErrorsIsFoundWhereItIsNotKnown) {
  std::vector<double> values = with_outliers(40000, 0.002, 10.0, 3);
  for (double& value : values) {
    value *= 1.2;
  }
  const MixtureFit fit = fit_mixture(histogram(values), false);
  EXPECT_NEAR(fit.magnitude, 12.0, 4.5 * 1.2 / std::sqrt(80.0));
  EXPECT_NEAR(fit.fraction, 0.002, 4.0 * std::sqrt(0.002 / 40000.0));
  EXPECT_DOUBLE_EQ(fit.gain, fit.gain_free_scale);
  EXPECT_NEAR(0.5 * fit.gain, mixture_gain(histogram(values), fit.fraction, fit.magnitude, false), 0.01 * fit.gain);
}

TEST(Tails, NormalScoresOfARightDistributionAreStandardNormal) {
  // Laplace noise of unit variance: P(beyond e) = exp(-sqrt(2) e)/2 on one side.
  Random random(43);
  constexpr std::size_t kCount = 40000;
  std::vector<double> values(kCount);
  for (double& value : values) {
    const double size = -std::log(random.uniform()) / std::numbers::sqrt2;
    value = random.uniform() < 0.5 ? -size : size;
  }
  NoiseAtFullRate noise({values});
  to_normal_scores(noise.data, [](double e) { return 0.5 * std::exp(-std::numbers::sqrt2 * e); });
  double square = 0.0;
  double fourth = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double score = noise.data.innovation[0][i];
    const double tail = 0.5 * std::exp(-std::numbers::sqrt2 * std::fabs(values[i]));
    ASSERT_NEAR(score, std::copysign(normal_quantile(1.0 - tail), values[i]), 2e-3) << values[i];
    square += score * score / kCount;
    fourth += score * score * score * score / kCount;
  }
  EXPECT_NEAR(square, 1.0, 4.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(fourth / (square * square), 3.0, 4.0 * std::sqrt(24.0 / kCount));
}

}  // namespace
}  // namespace driftlab::investigate
