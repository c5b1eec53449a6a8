/// White noise need not be independent, slow errors need not be Gaussian, axes may be loud together: each is told with
/// its size, and nothing is told of what is as a model has it.
#include "core/investigate/report/dependence.hpp"

#include "core/process/distributions.hpp"
#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace driftlab::investigate {
namespace {

using testing::StartsWith;

constexpr std::size_t kSamples = 50'000;
constexpr auto kCount = static_cast<double>(kSamples);

/// Scores as remains.hpp makes them, of one recording.
std::vector<double> scores_of(const std::vector<double>& values) {
  std::vector<std::size_t> order(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    order[i] = i;
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> scores(values.size());
  for (std::size_t rank = 0; rank < order.size(); ++rank) {
    scores[order[rank]] = normal_quantile((static_cast<double>(rank) + 0.5) / static_cast<double>(values.size()));
  }
  return scores;
}

Remainder dependence(const std::vector<double>& values) {
  return dependence_over_time(scores_of(values), std::vector<unsigned char>(values.size(), 1), "r0/gz");
}

/// Of a deviation of 1 + c h_(t-3) the sizes three samples apart correlate by sqrt(2) c to first order.
TEST(Dependence, TellsThatErrorsAreLargerAfterLargeOnes) {
  constexpr double kShare = 0.04;
  std::vector<double> values = white(kSamples, 11);
  for (std::size_t i = 3; i < values.size(); ++i) {
    const double before = values[i - 3];
    values[i] *= 1.0 + kShare * (before * before - 1.0) / std::numbers::sqrt2;
  }
  const Remainder found = dependence(values);
  EXPECT_THAT(found.sentence, StartsWith("r0/gz: errors are larger 3 samples after a large one (correlation "));
  const double r = std::numbers::sqrt2 * kShare;
  EXPECT_NEAR(found.observed, 0.5 * kCount * r * r, 5.0 * std::sqrt(kCount) * r);
  EXPECT_EQ(found.places, 24.0);
}

/// Of s + c h_(t-1) the score correlates with the size before by c.
TEST(Dependence, TellsThatErrorsLeanToOneSideAfterLargeOnes) {
  constexpr double kShare = 0.05;
  const std::vector<double> drawn = white(kSamples, 12);
  std::vector<double> values = drawn;
  for (std::size_t i = 1; i < values.size(); ++i) {
    values[i] += kShare * (drawn[i - 1] * drawn[i - 1] - 1.0) / std::numbers::sqrt2;
  }
  const Remainder found = dependence(values);
  EXPECT_THAT(found.sentence, StartsWith("r0/gz: errors lean to one side a sample after a large one"));
  EXPECT_NEAR(found.observed, 0.5 * kCount * kShare * kShare, 5.0 * std::sqrt(kCount) * kShare);
}

TEST(Dependence, SeesNoPairOfWhichOneIsNotInUse) {
  std::vector<double> values = white(kSamples, 13);
  std::vector<unsigned char> used(kSamples, 1);
  for (std::size_t i = 1; i < kSamples; i += 2) {
    values[i] = 5.0 * values[i - 1];
    used[i] = 0;
  }
  EXPECT_LT(dependence_over_time(values, used, "r0/gz").observed, 15.0);
}

/// x is half the square of a normal number at each of 24 places.
TEST(Dependence, OfIndependentNoiseIsAsLargeAsItIsSaidToBe) {
  constexpr int kSeeds = 200;
  int beyond = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Remainder found = dependence(white(4000, 200 + seed));
    beyond += found.places * std::exp(-found.observed) < 0.1 ? 1 : 0;
  }
  EXPECT_LE(beyond, 20) << "exp(-x) is above the chance of two sides, and Bonferroni's product above that of any";
}

/// Shocks that die away within ten samples, one in a thousand: their means are far off more often, and to one side.
TEST(SlowDistribution, TellsOfShocksAndOfTheirSide) {
  for (const bool one_sided : {true, false}) {
    std::vector<double> values = white(kSamples, 14);
    for (std::size_t k = 0; k < kSamples / 1000; ++k) {
      const double side = one_sided || k % 2 == 0 ? 1.0 : -1.0;
      for (std::size_t i = 0; i < 16; ++i) {
        values[1000 * k + 500 + i] += side * 2.5;
      }
    }
    const Remainder found = slow_distribution(scores_of(values), 0.02, "r0/gz");
    EXPECT_GT(found.observed, 20.0);
    EXPECT_THAT(found.sentence, StartsWith("r0/gz: means over "));
    EXPECT_THAT(found.sentence, testing::HasSubstr(one_sided ? "one side" : "far off more often"));
  }
}

TEST(SlowDistribution, OfGaussianNoiseIsAsLargeAsItIsSaidToBe) {
  constexpr int kSeeds = 400;
  int beyond = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Remainder found = slow_distribution(white(900, 700 + seed), 0.02, "r0/gz");
    EXPECT_EQ(found.places, 2.0) << "225 means over four, by skewness and kurtosis";
    beyond += normal_tail(std::sqrt(2.0 * found.observed)) * 2.0 < 0.005 ? 1 : 0;
  }
  // Two tests: four are expected, and twelve are far beyond them.
  EXPECT_LE(beyond, 12);
}

TEST(SharedLoudness, IsToldBeyondWhatACorrelationMakes) {
  const std::vector<double> scale = white(kSamples, 15);
  const std::vector<double> common = white(kSamples, 16);
  std::vector<double> a = white(kSamples, 17);
  std::vector<double> b = white(kSamples, 18);
  std::vector<double> c = white(kSamples, 19);
  for (std::size_t i = 0; i < kSamples; ++i) {
    const double loud = 1.0 + 0.1 * scale[i];
    c[i] = std::sqrt(0.5) * (c[i] + common[i]);
    a[i] = std::sqrt(0.5) * (a[i] + common[i]);
    b[i] *= loud;
  }
  EXPECT_LT(shared_loudness(Series(a), Series(c), "gx and gy of r0").observed, 10.0) << "correlated by a half";
  std::vector<double> d = white(kSamples, 20);
  for (std::size_t i = 0; i < kSamples; ++i) {
    d[i] *= 1.0 + 0.1 * scale[i];
  }
  const Remainder found = shared_loudness(Series(b), Series(d), "gx and gy of r0");
  EXPECT_THAT(found.sentence, StartsWith("gx and gy of r0: the two are loud at the same time"));
  // Squares of (1 + q u) z covary by the variance of (1 + q u)^2, 4 q^2 + 2 q^4, over that of each.
  const double shared = 4.0 * 0.01 + 2.0 * 1e-4;
  const double own = 3.0 * (1.0 + 6.0 * 0.01 + 3.0 * 1e-4) - 1.01 * 1.01;
  const double r = shared / own;
  EXPECT_NEAR(found.observed, 0.5 * kCount * r * r, 5.0 * std::sqrt(kCount) * r);
}

}  // namespace
}  // namespace driftlab::investigate
