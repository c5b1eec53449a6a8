// What the scatter of a log likelihood over blocks of time says of an estimate's error.
#include "core/navigate/drive/profile_parabola.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace driftlab::drive {
namespace {

constexpr int kRuns = 600;
constexpr int kBlocks = 27;          // a drive of 540 s in blocks of 20 s
constexpr int kBlockLength = 80;     // with 4 Hz fixes
constexpr double kCorrelated = 0.9;  // from fix to fix: 2.4 s
constexpr double kTrue = 0.3;

/// z_t = x h_t + e_t for a filter that believes e white with variance 1: log likelihoods at x = -1, 0, 1. The signal h
/// lasts as turns do, and e is a Gauss-Markov sequence of variance 1 with the given correlation.
std::array<ProfilePoint, 3> series(std::uint64_t seed, double correlation) {
  std::array<ProfilePoint, 3> points{{{-1.0, {}}, {0.0, {}}, {1.0, {}}}};
  Random random(seed, 1);
  double error = random.normal();
  double signal = random.normal();
  for (int block = 0; block < kBlocks; ++block) {
    for (ProfilePoint& point : points) {
      point.blocks.push_back(0.0);
    }
    for (int t = 0; t < kBlockLength; ++t) {
      for (ProfilePoint& point : points) {
        const double innovation = (kTrue - point.at) * signal + error;
        point.blocks.back() -= 0.5 * innovation * innovation;
      }
      error = correlation * error + std::sqrt(1.0 - correlation * correlation) * random.normal();
      signal = kCorrelated * signal + std::sqrt(1.0 - kCorrelated * kCorrelated) * random.normal();
    }
  }
  return points;
}

/// Shares of `kRuns` series whose 95 % interval holds the truth, by the stated error and by 1.5 times the curvature's;
/// and roots of the mean square of two errors over the curvature's.
struct Coverage {
  double stated = 0.0, by_curvature = 0.0;
  double times_stated = 0.0, times_sandwich = 0.0;
};

Coverage coverage(double correlation) {
  Coverage found;
  for (int run = 0; run < kRuns; ++run) {
    const ProfileEstimate estimate = parabola_through(series(100 + static_cast<std::uint64_t>(run), correlation));
    EXPECT_TRUE(estimate.sound);
    const double off = std::abs(estimate.value - kTrue);
    found.stated += off < 1.96 * estimate.se ? 1.0 / kRuns : 0.0;
    found.by_curvature += off < 1.96 * 1.5 * estimate.curvature_se ? 1.0 / kRuns : 0.0;
    found.times_stated += std::pow(estimate.se / estimate.curvature_se, 2.0) / kRuns;
    found.times_sandwich += std::pow(estimate.sandwich_se / estimate.curvature_se, 2.0) / kRuns;
  }
  found.times_stated = std::sqrt(found.times_stated);
  found.times_sandwich = std::sqrt(found.times_sandwich);
  return found;
}

TEST(ProfileParabola, AnErrorCoversWhereInnovationsLast) {
  // With correlations r = 0.9 of innovations and of what they are regressed on, the estimate scatters by
  // sqrt((1 + r^2)/(1 - r^2)) = 3.09 times what the curvature says. Blocks of 80 steps lose pairs across their borders,
  // (2 r^2/(1 - r^2)^2)/80 = 0.56 of 9.5: 2.99. The larger of the scatter of 27 and of 14 (J of 14 is 1.4 times more
  // uncertain) is 5 to 10 % more. Without blocks 1.5 times the curvature's error covers erf(1.96 * 1.5/3.09/sqrt(2)),
  // 66 %. 600 series count a share to 1 and 2 %, times three.
  const Coverage found = coverage(kCorrelated);
  EXPECT_GT(found.stated, 0.92);
  EXPECT_LT(found.stated, 0.99);
  EXPECT_NEAR(found.by_curvature, 0.66, 0.06);
  EXPECT_NEAR(found.times_sandwich, 3.15, 0.2);
}

TEST(ProfileParabola, WhiteInnovationsLeaveTheErrorOfTheCurvature) {
  // J/H is 1 on average; the larger of two is a little more. It is rarely above 1.5^2: what is stated is the floor.
  const Coverage found = coverage(0.0);
  EXPECT_NEAR(found.times_sandwich, 1.0, 0.2);
  EXPECT_NEAR(found.times_stated, 1.5, 0.03);
  EXPECT_GT(found.stated, 0.985);
}

TEST(ProfileParabola, WhatDriftsThroughADriveShowsInLongerBlocks) {
  // Slopes of 24 blocks that rise evenly, as of a clock with another rate: the sums of pairs scatter by twice as much,
  // and those of fours, of which six are left, by four times.
  ProfilePoint low{-1.0, {}};
  ProfilePoint middle{0.0, {}};
  ProfilePoint high{1.0, {}};
  double squares = 0.0;
  for (int block = 0; block < 24; ++block) {
    const double top = 3.0 * (block - 11.5) / 11.5;
    low.blocks.push_back(-0.5 * (1.0 + top) * (1.0 + top));
    middle.blocks.push_back(-0.5 * top * top);
    high.blocks.push_back(-0.5 * (1.0 - top) * (1.0 - top));
    const double of_four = 3.0 * (block / 4 - 2.5) * 16.0 / 11.5;
    squares += block % 4 == 0 ? of_four * of_four : 0.0;
  }
  const ProfileEstimate estimate = parabola_through({low, middle, high});
  EXPECT_NEAR(estimate.value, 0.0, 1e-12);
  EXPECT_NEAR(estimate.curvature_se, 1.0 / std::sqrt(24.0), 1e-12);
  EXPECT_NEAR(estimate.sandwich_se, std::sqrt(6.0 / 5.0 * squares) / 24.0, 1e-12);
  EXPECT_DOUBLE_EQ(estimate.se, estimate.sandwich_se);
}

TEST(ProfileParabola, EstimateAndTopAreThoseOfTheLikelihood) {
  // l = -(x - 2)^2 + 7 in one block and -3 (x - 2)^2 - 1 in another: no scatter at the top.
  const auto at = [](double x) {
    return ProfilePoint{x, {7.0 - (x - 2.0) * (x - 2.0), -1.0 - 3.0 * (x - 2.0) * (x - 2.0)}};
  };
  const ProfileEstimate estimate = parabola_through({at(0.5), at(1.0), at(4.0)});
  ASSERT_TRUE(estimate.sound);
  EXPECT_NEAR(estimate.value, 2.0, 1e-12);
  EXPECT_NEAR(estimate.top, 6.0, 1e-12);
  EXPECT_NEAR(estimate.divisor, 2.25, 1e-12);
  EXPECT_NEAR(estimate.se, std::sqrt(2.25 / 8.0), 1e-12);
  // Tops 4 apart: slopes of the blocks at the common top are 6 and -6.
  const auto apart = [](double x) { return ProfilePoint{x, {-(x - 2.0) * (x - 2.0), -3.0 * (x + 2.0) * (x + 2.0)}}; };
  const ProfileEstimate torn = parabola_through({apart(-2.0), apart(0.0), apart(1.0)});
  EXPECT_NEAR(torn.value, -1.0, 1e-12);
  EXPECT_NEAR(torn.divisor, 2.0 * (36.0 + 36.0) / 8.0, 1e-12);
  EXPECT_NEAR(torn.sandwich_se, 12.0 / 8.0, 1e-12);
  EXPECT_NEAR(torn.se, 12.0 / 8.0, 1e-12);
}

TEST(ProfileParabola, AgainstNothingAParabolaIsJudgedAsByItsSlopes) {
  // Blocks with tops at t_b and one curvature: d_b = x (t_b - x/2), whose scatter is x^2 times that of the slopes t_b -
  // x.
  const auto at = [](double x) {
    ProfilePoint point{x, {}};
    for (int block = 0; block < 27; ++block) {
      const double top = 1.5 + 2.5 * std::sin(2.0 * block);
      point.blocks.push_back(-0.5 * (x - top) * (x - top));
    }
    return point;
  };
  ProfileEstimate estimate = parabola_through({at(0.0), at(1.0), at(3.0)});
  const ProfileEstimate by_slopes = estimate;
  ASSERT_GT(by_slopes.divisor, kLeastDivisor);
  judge_against_nothing(estimate, estimate.value, at(estimate.value), at(0.0));
  EXPECT_NEAR(estimate.divisor, by_slopes.divisor, 1e-9);
  EXPECT_NEAR(estimate.se, by_slopes.se, 1e-9);
  EXPECT_NEAR(estimate.score, 0.5 * std::pow(by_slopes.value / by_slopes.se, 2.0), 1e-9);
}

TEST(ProfileParabola, WhatIsNoBetterThanNothingIsNotJudged) {
  ProfileEstimate estimate{.sound = true, .se = 2.0, .divisor = 3.0};
  judge_against_nothing(estimate, 0.5, {0.5, {-2.0, -2.0}}, {0.0, {-1.0, -2.0}});
  EXPECT_DOUBLE_EQ(estimate.se, 2.0);
  EXPECT_DOUBLE_EQ(estimate.divisor, 3.0);
  EXPECT_DOUBLE_EQ(estimate.score, 0.0);
}

TEST(ProfileParabola, WithoutATopThereIsNoEstimate) {
  EXPECT_FALSE(parabola_through({{{-1.0, {1.0}}, {0.0, {0.0}}, {1.0, {1.0}}}}).sound);
  const double never = -std::numeric_limits<double>::infinity();
  EXPECT_FALSE(parabola_through({{{-1.0, {never}}, {0.0, {0.0}}, {1.0, {-1.0}}}}).sound);
  // One block says nothing of scatter; the top is not sought beyond the values.
  const ProfileEstimate one = parabola_through({{{-1.0, {-9.0}}, {0.0, {-4.0}}, {1.0, {-1.0}}}});
  EXPECT_TRUE(one.sound);
  EXPECT_DOUBLE_EQ(one.divisor, 2.25);
  EXPECT_DOUBLE_EQ(one.value, 1.0);
  EXPECT_NEAR(one.top, -1.0, 1e-12);
}

}  // namespace
}  // namespace driftlab::drive
