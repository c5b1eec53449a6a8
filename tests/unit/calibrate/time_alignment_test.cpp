#include "core/calibrate/time_alignment.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

/// A turning table: 88 deg/s at most, periods of 8 s and 3 s.
double rate(double t) { return 60.0 * std::sin(0.785 * t) + 28.0 * std::sin(2.1 * t + 0.4); }

/// The channel and its reference, `delay` later; the channel has a gain, an offset and noise of deviation `sigma`,
/// correlated from sample to sample by `phi`.
std::pair<std::vector<double>, std::vector<double>> series(std::size_t count, double delay, double sigma, double phi,
                                                           std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<double> measured(count);
  std::vector<double> reference(count);
  double noise = sigma * normal(random);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = kDt * static_cast<double>(i);
    reference[i] = rate(t);
    measured[i] = 1.5 + 1.02 * rate(t - delay) + noise;
    noise = phi * noise + sigma * std::sqrt(1.0 - phi * phi) * normal(random);
  }
  return {measured, reference};
}

TEST(TimeAlignment, FindsFractionsOfASample) {
  for (const double delay : {0.0, 0.0037, -0.0253, 0.1149, -1.5}) {
    const auto [measured, reference] = series(3000, delay, 0.0, 0.0, 1);
    const auto found = align_reference(measured, reference, kDt);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_TRUE(found->converged);
    // Cubic convolution of a sine of angle w dt a sample is wrong by (w dt)^3/24 or so: 1e-6 of a sample here.
    EXPECT_NEAR(found->delay_s.value, delay, 1e-6) << delay;
    EXPECT_NEAR(found->gain, 1.02, 1e-5);
    EXPECT_NEAR(found->offset, 1.5, 1e-3);
  }
}

TEST(TimeAlignment, IntervalsHoldTheTruthInNinetyFivePercent) {
  // 300 runs each: standard error 1.3 %. Errors correlated over some samples widen the interval as they should.
  for (const double phi : {0.0, 0.8}) {
    int inside = 0;
    for (std::uint64_t run = 0; run < 300; ++run) {
      const auto [measured, reference] = series(2000, 0.0137, 0.5, phi, 50 + run);
      const auto found = align_reference(measured, reference, kDt, {.max_shift_s = 0.1});
      ASSERT_TRUE(found);
      inside += found->delay_s.ci95.contains(0.0137) ? 1 : 0;
    }
    EXPECT_NEAR(inside / 300.0, 0.95, phi == 0.0 ? 0.04 : 0.06) << phi;
  }
}

TEST(TimeAlignment, GivesTheReferenceAtTheTimeOfTheChannel) {
  const auto [measured, reference] = series(3000, 0.0137, 0.0, 0.0, 1);
  const std::vector<double> moved = delayed(reference, 1.37);
  for (std::size_t i = 100; i < 2900; ++i) {
    EXPECT_NEAR(1.5 + 1.02 * moved[i], measured[i], 1e-4);
  }
}

TEST(TimeAlignment, RefusesWhatCannotBeAligned) {
  const auto [measured, reference] = series(1000, 0.0, 0.1, 0.0, 1);
  EXPECT_FALSE(align_reference(measured, std::vector<double>(1000, 1.0), kDt));
  EXPECT_FALSE(align_reference(measured, std::span<const double>(reference).first(999), kDt));
  EXPECT_FALSE(align_reference(measured, reference, kDt, {.max_shift_s = 10.0}));
  EXPECT_FALSE(align_reference(measured, reference, 0.0));
}

}  // namespace
}  // namespace driftlab
