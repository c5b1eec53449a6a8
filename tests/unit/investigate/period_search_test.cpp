// The period of what comes again: found where no single line stands out, and not found in noise.
#include "core/investigate/unnamed/period_search.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace driftlab::investigate {
namespace {

constexpr double kStep = 0.02;
constexpr std::size_t kSamples = 15'000;

/// White noise of size 1 with pulses of `height` for `width_s` in every `period_s`.
std::vector<double> pulses(std::uint64_t seed, double height, double period_s, double width_s) {
  Random random(seed);
  std::vector<double> values(kSamples);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool on = std::fmod(static_cast<double>(i) * kStep, period_s) < width_s;
    values[i] = random.normal() + (on ? height : 0.0);
  }
  return values;
}

std::optional<FoundPeriod> found_in(const std::vector<double>& values) {
  return find_period(values.size(), kStep, [&](std::size_t i) { return values[i]; });
}

TEST(PeriodSearch, FindsATrainOfPulsesOfWhichNoLineStandsOut) {
  // Seventeen standard deviations in all, 38 pulses of five samples each: 1.2 of a sample.
  for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
    const double period = 7.9 + 0.37 * static_cast<double>(seed);
    const auto found = found_in(pulses(seed, 1.2, period, 0.1));
    ASSERT_TRUE(found) << seed;
    // Over 300 s a pulse keeps its place by its width.
    EXPECT_NEAR(found->period_s, period, 0.1 / 300.0 * period) << seed;
    EXPECT_GE(found->teeth, 16U) << seed;
  }
}

TEST(PeriodSearch, OffersAPeriodOfNoiseAsSeldomAsItSays) {
  // A comb is offered where its chance times all combs is below one, by a bound that is not reached.
  int offered = 0;
  for (std::uint64_t seed = 100; seed < 140; ++seed) {
    offered += found_in(pulses(seed, 0.0, 1.0, 0.1)) ? 1 : 0;
  }
  EXPECT_LE(offered, 8);
}

TEST(PeriodSearch, LeavesOutWhatIsMissingAndShortSeries) {
  std::vector<double> values = pulses(5, 1.2, 8.0, 0.1);
  for (std::size_t i = 3'000; i < 6'000; ++i) {
    values[i] = 0.0;
  }
  for (double& value : values) {
    value += value != 0.0 ? 100.0 : 0.0;  // a mean of the others is no edge of the gap
  }
  const auto found = found_in(values);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->period_s, 8.0, 8e-3);
  EXPECT_FALSE(found_in(std::vector<double>(100, 1.0)));
  EXPECT_FALSE(found_in(std::vector<double>(1'000, 0.0)));
}

}  // namespace
}  // namespace driftlab::investigate
