#include "core/variance/gappy_variance.hpp"

#include "core/process/model.hpp"
#include "core/variance/haar_variance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

GappySamples random_gaps(std::vector<double> values, double share, Random& random) {
  GappySamples samples{std::move(values), {}};
  samples.missing.resize(samples.size());
  for (std::size_t t = 0; t < samples.size(); ++t) {
    samples.missing[t] = random.uniform() < share ? 1 : 0;
    samples.values[t] = samples.missing[t] != 0 ? std::nan("") : samples.values[t];  // never read
  }
  return samples;
}

TEST(GappyVariance, WithoutGapsItIsTheClassicalEstimate) {
  Random random(1);
  const Model model{*make_process("white_noise", {1.0}), *make_process("random_walk", {0.3})};
  const auto x = simulate(model, random, 1.0, 200);
  const HaarVariance curve = haar_variance(x, 0.0);
  const WholeWindowScan scan({x, {}});
  for (std::size_t j = 0; j < curve.scales(); ++j) {
    const auto whole = scan.at(curve.half[j]);
    ASSERT_TRUE(whole);
    EXPECT_NEAR(whole->variance, curve.variance[j], 1e-11 * curve.variance[0]);
    EXPECT_EQ(whole->windows, curve.coefficients(j));
  }
}

TEST(GappyVariance, IsUnbiasedWhereATwentiethIsMissing) {
  const Model model{*make_process("white_noise", {1.0}), *make_process("random_walk", {0.1})};
  constexpr int kRuns = 400;
  for (const std::size_t half : {std::size_t{1}, std::size_t{4}, std::size_t{8}}) {
    const double truth = haar_variance(model, static_cast<double>(half), 1.0);
    double mean = 0.0;
    double square = 0.0;
    for (int run = 0; run < kRuns; ++run) {
      Random random(21, static_cast<std::uint64_t>(run));
      const GappySamples samples = random_gaps(simulate(model, random, 1.0, 400), 0.05, random);
      const double value = WholeWindowScan(samples).at(half)->variance / truth;
      mean += value / kRuns;
      square += value * value / kRuns;
    }
    const double tolerance = 4.0 * std::sqrt((square - mean * mean) / kRuns);  // four standard errors
    EXPECT_LT(tolerance, 0.12);
    EXPECT_NEAR(mean, 1.0, tolerance) << half;
  }
}

TEST(GappyVariance, OneScanGivesEveryScaleAsItsDefinition) {
  Random random(4);
  const Model model{*make_process("white_noise", {1.0}), *make_process("random_walk", {0.3})};
  GappySamples samples = random_gaps(simulate(model, random, 1.0, 600), 0.01, random);
  for (const std::size_t missing : {std::size_t{0}, std::size_t{1}, std::size_t{599}}) {  // at both ends too
    samples.missing[missing] = 1;
  }
  const WholeWindowScan scan(samples);
  for (std::size_t half = 1; half <= 32; half *= 2) {
    double sum = 0.0;
    std::size_t windows = 0;
    for (std::size_t t = 0; t + 2 * half <= samples.size(); ++t) {
      double w = 0.0;
      bool whole = true;
      for (std::size_t k = 0; k < 2 * half; ++k) {
        whole = whole && samples.missing[t + k] == 0;
        w += (k < half ? -1.0 : 1.0) * samples.values[t + k] / (2.0 * static_cast<double>(half));
      }
      sum += whole ? w * w : 0.0;
      windows += whole ? 1 : 0;
    }
    ASSERT_GT(windows, 0U) << half;
    const auto found = scan.at(half);
    ASSERT_TRUE(found) << half;
    EXPECT_EQ(found->windows, windows) << half;
    EXPECT_EQ(scan.windows(half), windows) << half;
    EXPECT_NEAR(found->variance, sum / static_cast<double>(windows), 1e-10 * sum) << half;
  }
}

TEST(GappyVariance, NoWholeWindowIsNoEstimate) {
  GappySamples samples{std::vector<double>(16, 1.0), std::vector<std::uint8_t>(16, 0)};
  for (std::size_t t = 0; t < 16; t += 4) {
    samples.missing[t] = 1;
  }
  EXPECT_TRUE(WholeWindowScan(samples).at(1).has_value());
  EXPECT_FALSE(WholeWindowScan(samples).at(2).has_value());
  EXPECT_FALSE(WholeWindowScan(samples).at(9).has_value());
  EXPECT_FALSE(WholeWindowScan(samples).at(0).has_value());
  samples.missing.assign(16, 1);
  EXPECT_FALSE(WholeWindowScan(samples).at(1).has_value());
}

}  // namespace
}  // namespace driftlab
