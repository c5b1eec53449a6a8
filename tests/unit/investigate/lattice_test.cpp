#include "core/investigate/study/lattice.hpp"

#include "core/investigate/study/time_grid.hpp"
#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::investigate {
namespace {

TEST(Lattice, AStepWrittenWithFourDecimalsIsFoundToItsRounding) {
  Random random(1);
  std::vector<double> rows;
  const double step = 0.27574530;
  for (int i = 0; i < 20000; ++i) {
    const double value = step * std::round(0.4 * random.normal() / step);
    rows.push_back(std::round(value * 1e4) / 1e4);
  }
  const Lattice lattice = find_lattice(rows);
  EXPECT_NEAR(lattice.step, step, 5e-5);
  EXPECT_NEAR(lattice.decimals, 1e-4, 1e-12);
}

/// A recording in multiples of 0.05 deg/s was called finer than its decimals: 0.05 is five times 0.01 but for rounding.
TEST(Lattice, AStepOfFiveDecimalsIsFound) {
  Random random(4);
  std::vector<double> rows;
  for (int i = 0; i < 20000; ++i) {
    rows.push_back(0.05 * std::round(0.35 * random.normal() / 0.05));
  }
  const Lattice lattice = find_lattice(rows);
  EXPECT_NEAR(lattice.step, 0.05, 1e-9);
  EXPECT_NEAR(lattice.decimals, 0.01, 1e-12);
}

TEST(Lattice, DecimalsFinerThanTheNoiseAreNoLattice) {
  Random random(2);
  std::vector<double> rows;
  for (int i = 0; i < 20000; ++i) {
    rows.push_back(std::round(random.normal() * 1e5) / 1e5);
  }
  EXPECT_EQ(find_lattice(rows).step, 0.0);
}

TEST(TimeGrid, MissingSamplesAreCountedAndTheScatterOfStampsIsMeasured) {
  Random random(3);
  std::vector<double> stamps;
  std::size_t missing = 0;
  for (int i = 0; i < 20000; ++i) {
    if (i > 0 && i < 19999 && random.uniform() < 0.05) {
      ++missing;
      continue;
    }
    stamps.push_back(0.01 * i + 2e-4 * random.normal());
  }
  const auto grid = fit_time_grid(stamps, 100.0);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->stamps.missing, missing);
  EXPECT_NEAR(grid->stamps.scatter_s, 2e-4, 4.0 * 2e-4 / std::sqrt(2.0 * 19000.0));
}

TEST(TimeGrid, StampsRoundedToMillisecondsDoNotScatter) {
  std::vector<double> stamps;
  for (int i = 0; i < 20000; ++i) {
    stamps.push_back(std::round(i / 60.0 * 1e3) / 1e3);
  }
  const auto grid = fit_time_grid(stamps, 60.0);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->stamps.missing, 0U);
  EXPECT_LT(grid->stamps.scatter_s, 3e-5);  // the rounding's own 0.29 ms is taken off
}

}  // namespace
}  // namespace driftlab::investigate
