/// The grid on which the samples of a study's recording lie, from time stamps as loggers write them.
#include "core/investigate/study/time_grid.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr double kInterval = 0.01;

struct Kept {
  std::vector<double> stamps;
  std::vector<std::size_t> place;
};

/// Stamps of 20,000 samples with an error of `jitter_s` each, written to 10 us, of which a share is lost at random.
Kept lossy(double share, double jitter_s, std::uint64_t seed) {
  Random random(seed);
  Kept kept;
  for (std::size_t i = 0; i < 20000; ++i) {
    const double stamp = static_cast<double>(i) * kInterval + jitter_s * random.normal();
    const bool lost = random.uniform() < share && i > 0;
    if (!lost) {
      kept.stamps.push_back(std::round(stamp * 1e5) * 1e-5);
      kept.place.push_back(i);
    }
  }
  return kept;
}

/// A fifth of the samples was lost at random and the stamps scattered by half a millisecond: the median step was 2 %
/// too long, rows were taken as evenly spaced at 80 Hz, and a study with a sister recording at 100 Hz was not examined.
TEST(TimeGrid, SamplesThatAreLostAtRandomLeaveTheRate) {
  for (const double share : {0.02, 0.2, 0.4}) {
    for (const double jitter_s : {0.0, 0.0005}) {
      const Kept kept = lossy(share, jitter_s, 11);
      const auto grid = fit_time_grid(kept.stamps, std::nullopt);
      ASSERT_TRUE(grid) << grid.error().message;
      EXPECT_NEAR(grid->dt_s / kInterval, 1.0, 1e-5) << share << " " << jitter_s;
      EXPECT_EQ(grid->place, kept.place) << share << " " << jitter_s;
      EXPECT_EQ(grid->stamps.missing, kept.place.back() + 1 - kept.place.size());
      EXPECT_NEAR(grid->stamps.scatter_s, jitter_s, 2e-5);
    }
  }
}

/// Two sessions a year apart in one file asked for a grid of three thousand million points.
TEST(TimeGrid, AYearWithoutSamplesIsNoRecording) {
  std::vector<double> stamps;
  for (std::size_t i = 0; i < 2000; ++i) {
    stamps.push_back(static_cast<double>(i) * kInterval + (i < 1000 ? 0.0 : 3.0e7));
  }
  const auto grid = fit_time_grid(stamps, std::nullopt);
  ASSERT_FALSE(grid);
  EXPECT_EQ(grid.error().code, ErrorCode::LimitExceeded);
}

TEST(TimeGrid, WhatCannotBeAClockIsRefused) {
  const auto code = [](std::vector<double> stamps) {
    const auto grid = fit_time_grid(stamps, std::nullopt);
    return grid ? ErrorCode::Internal : grid.error().code;
  };
  EXPECT_EQ(code({0.0, 0.01, 0.005}), ErrorCode::NonMonotonicTime);
  EXPECT_EQ(code({0.0, std::numeric_limits<double>::quiet_NaN(), 0.02}), ErrorCode::NonFinite);
  EXPECT_EQ(code({1.0, 1.0, 1.0}), ErrorCode::InconsistentSampling);
}

}  // namespace
}  // namespace driftlab::investigate
