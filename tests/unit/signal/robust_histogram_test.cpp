#include "core/signal/robust_histogram.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace driftlab {
namespace {

TEST(RobustHistogram, KeepsTheWidthOfTheCoreAndCountsWhatLiesBeyond) {
  // Gaussian noise with 1 % of gross errors: the width stays that of the noise within 2 %, the errors are outside.
  std::mt19937_64 generator(5);
  std::normal_distribution<double> noise(3.0, 0.5);
  std::vector<double> x(50000);
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = noise(generator) + (i % 100 == 0 ? 50.0 : 0.0);
  }
  const auto found = robust_histogram(x, 64);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->median, 3.0, 0.02);
  EXPECT_NEAR(found->sigma, 0.5, 0.01);
  EXPECT_EQ(found->above, 500U);
  EXPECT_EQ(found->below, 0U);
  EXPECT_EQ(found->edges.size(), 65U);
  EXPECT_EQ(std::accumulate(found->counts.begin(), found->counts.end(), std::size_t{0}), x.size() - 500);
  const double middle = found->gaussian[32];
  EXPECT_NEAR(static_cast<double>(found->counts[32]), middle, 5.0 * std::sqrt(middle) + 0.01 * middle);
}

TEST(RobustHistogram, SaysNothingWhereMostValuesAreEqual) {
  // A frozen or very coarse channel has no robust width: a figure must not divide by it.
  std::vector<double> x(100, 1.0);
  x[0] = 2.0;
  EXPECT_FALSE(robust_histogram(x, 64));
  EXPECT_FALSE(robust_histogram({}, 64));
}

}  // namespace
}  // namespace driftlab
