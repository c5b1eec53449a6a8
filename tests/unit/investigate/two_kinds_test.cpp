/// Loud and quiet frames: parameters that were put in come out, and where all frames are alike nothing is gained.
#include "core/investigate/causes/two_kinds.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr FrameLaw kLaw{3.0, 20.0};

double mean_of_exponentials(int count, Random& random) {
  double sum = 0.0;
  for (int k = 0; k < count; ++k) {
    sum -= std::log(1.0 - random.uniform()) / count;
  }
  return sum;
}

/// Two recordings; runs of loud frames last ten on the average.
FrameRuns frames(double loud, double ratio, std::size_t count, std::uint64_t seed) {
  constexpr double kLength = 10.0;
  Random random(seed, 2);
  FrameRuns runs;
  for (int r = 0; r < 2; ++r) {
    std::vector<double>& run = runs.emplace_back();
    bool is_loud = random.uniform() < loud;
    for (std::size_t f = 0; f < count; ++f) {
      run.push_back((is_loud ? ratio : 1.0) * mean_of_exponentials(3, random) / mean_of_exponentials(20, random));
      const double turn = is_loud ? 1.0 / kLength : loud / (1.0 - loud) / kLength;
      is_loud = random.uniform() < turn ? !is_loud : is_loud;
    }
  }
  return runs;
}

TEST(TwoKinds, AreEstimated) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const FrameRuns runs = frames(0.15, 4.0, 2000, seed);
    const TwoKinds kinds = fit_two_kinds(kLaw, runs);
    EXPECT_NEAR(kinds.fraction, 0.15, 0.07) << seed;                 // 60 runs: 0.15 0.85 sqrt(2 / 60) = 0.023
    EXPECT_NEAR(std::log(kinds.ratio), std::log(4.0), 0.2) << seed;  // 600 loud frames of three ordinates each
    EXPECT_NEAR(kinds.scale, 1.0, 0.06) << seed;
    EXPECT_GT(kinds.gain, 300.0) << seed;
    EXPECT_GT(kinds.length, 2.0) << seed;
    double share = 0.0;
    for (const std::vector<double>& run : loud_chances(kLaw, runs, kinds)) {
      for (const double p : run) {
        share += p / 4000.0;
      }
    }
    EXPECT_NEAR(share, kinds.fraction, 0.01) << seed;  // at the maximum the mean chance is the fraction
  }
}

/// The likelihood of a chain by summing over every course of its kinds.
TEST(TwoKinds, FilterIsTheSumOverAllCourses) {
  const FrameRuns runs{{0.4, 2.5, 3.5, 0.9, 1.1, 4.0}};
  const TwoKinds kinds{0.9, 3.0, 0.2, 5.0, 0.0};
  const double leave = 1.0 / kinds.length;
  const double enter = kinds.fraction / (1.0 - kinds.fraction) * leave;
  double sum = 0.0;
  std::vector<double> loud(6, 0.0);
  for (unsigned course = 0; course < 64; ++course) {
    double p = 1.0;
    for (unsigned f = 0; f < 6; ++f) {
      const bool now = ((course >> f) & 1U) != 0;
      const bool before = f > 0 && ((course >> (f - 1)) & 1U) != 0;
      const double turn = f == 0   ? (now ? kinds.fraction : 1.0 - kinds.fraction)
                          : before ? (now ? 1.0 - leave : leave)
                                   : (now ? enter : 1.0 - enter);
      p *= turn * std::exp(kLaw.log_density(runs[0][f], kinds.scale * (now ? kinds.ratio : 1.0)));
    }
    sum += p;
    for (unsigned f = 0; f < 6; ++f) {
      loud[f] += ((course >> f) & 1U) != 0 ? p : 0.0;
    }
  }
  EXPECT_NEAR(log_likelihood(kLaw, runs, kinds), std::log(sum), 1e-9);
  const FrameRuns chances = loud_chances(kLaw, runs, kinds);
  for (unsigned f = 0; f < 6; ++f) {
    EXPECT_NEAR(chances[0][f], loud[f] / sum, 1e-9) << f;
  }
}

/// Twice the log likelihood ratio of three more parameters, the best of a few lengths.
TEST(TwoKinds, GainNothingWhereAllFramesAreAlike) {
  for (std::uint64_t seed = 11; seed <= 30; ++seed) {
    EXPECT_LT(fit_two_kinds(kLaw, frames(0.0, 1.0, 1000, seed)).gain, 16.0) << seed;
  }
}

}  // namespace
}  // namespace driftlab::investigate
