#include "core/signal/full_scale.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace driftlab {
namespace {

std::vector<double> noise() {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, 0.1);
  std::vector<double> values(6000);
  std::generate(values.begin(), values.end(), [&] { return normal(random); });
  return values;
}

TEST(FullScale, IsWhereSamplesPileUp) {
  std::vector<double> both = noise();
  std::vector<double> above = both;
  for (std::size_t i = 0; i < both.size(); ++i) {
    both[i] = std::clamp(both[i], -0.1, 0.12);
    above[i] = std::min(above[i], 0.1);
  }
  EXPECT_EQ(find_rails("gz", both).low, -0.1);
  EXPECT_EQ(find_rails("gz", both).high, 0.12);
  EXPECT_EQ(find_rails("gz", above).low, std::nullopt);
  EXPECT_EQ(find_rails("gz", above).high, 0.1);
  EXPECT_EQ(find_rails("gz", noise()).high, std::nullopt);
}

TEST(FullScale, IsNoNumberThatStandsForMissing) {
  std::vector<double> values = noise();
  for (double& value : values) {
    value = std::min(value, 0.1);
  }
  std::fill(values.begin() + 100, values.begin() + 120, 9999.0);
  EXPECT_EQ(find_rails("gz", values).high, 0.1);
}

}  // namespace
}  // namespace driftlab
