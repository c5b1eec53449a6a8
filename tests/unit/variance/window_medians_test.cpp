#include "core/variance/window_medians.hpp"

#include "core/process/random.hpp"
#include "core/signal/median.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace driftlab {
namespace {

/// On a coarse lattice too, where most values are equal.
TEST(WindowMedians, AreThoseOfEachWindowByItself) {
  Random random(41);
  for (const double step : {0.0, 0.8}) {
    std::vector<double> x(2000);
    for (double& value : x) {
      value = step > 0.0 ? step * std::round(random.normal() / step) : random.normal();
    }
    for (const std::size_t length : {1U, 3U, 5U, 15U, 63U, 251U}) {
      WindowMedians windows(length);
      for (const std::size_t stride : {1U, 3U, 62U}) {
        for (const std::size_t count :
             {std::size_t{1}, std::size_t{7}, std::size_t{8}, (x.size() - length) / stride + 1}) {
          std::vector<double> found(count);
          windows.find(x.data(), stride, count, found.data());
          for (std::size_t k = 0; k < count; ++k) {
            const auto from = x.begin() + static_cast<std::ptrdiff_t>(k * stride);
            std::vector<double> window(from, from + static_cast<std::ptrdiff_t>(length));
            ASSERT_EQ(found[k], take_median(window)) << length << " " << stride << " " << k;
          }
        }
      }
    }
  }
}

TEST(WindowMedians, LeaveOutTheExchangesThatTheMiddleDoesNotDependOn) {
  EXPECT_EQ(WindowMedians(3).exchanges(), 3U);
  EXPECT_EQ(WindowMedians(15).exchanges(), 49U);
  EXPECT_EQ(WindowMedians(251).exchanges(), 3143U);
}

}  // namespace
}  // namespace driftlab
