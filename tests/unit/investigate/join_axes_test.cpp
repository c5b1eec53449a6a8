#include "core/investigate/search/join_axes.hpp"

#include "core/investigate/causes/cause.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace driftlab::investigate {
namespace {

/// A cause of the registry of which one value moves every axis, or one of which every axis has its own.
const Cause& cause_with(bool one_for_all_axes) {
  return *std::find_if(cause_registry().begin(), cause_registry().end(), [&](const Cause& cause) {
    const MeanEffect* const effect = cause.as<MeanEffect>();
    return effect != nullptr && effect->one_for_all_axes == one_for_all_axes;
  });
}

Evidence on_axis(const Cause& cause, std::size_t group, double value, double half) {
  Evidence evidence;
  evidence.cause = &cause;
  evidence.group = group;
  evidence.members = {0};
  evidence.score = 100.0;
  evidence.gain = 102.0;
  evidence.parameters = {{"r", {value, {value - half, value + half}}, {}}};
  evidence.heldout_gain = 60.0;
  evidence.heldout_samples = 10000.0;
  evidence.heldout = true;
  return evidence;
}

/// A lever arm was found on two accelerometers of 10,000 samples each; the joined finding added up what both gained on
/// held-out samples but counted the samples of one, so that its gain per sample was twice that of either axis.
TEST(JoinAxes, GainPerSampleIsThatOfTheAxesItIsJoinedFrom) {
  const Cause& cause = cause_with(true);
  std::vector<Evidence> found{on_axis(cause, 0, 0.10, 0.02), on_axis(cause, 1, 0.13, 0.01)};
  join_axes(found);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].heldout_gain, 120.0);
  EXPECT_EQ(found[0].heldout_samples, 20000.0);
  EXPECT_EQ(found[0].also_groups, std::vector<std::size_t>{1});
  EXPECT_EQ(found[0].score, 200.0);
  // Weights 1/0.04^2 and 1/0.02^2: the mean is (0.10 + 4 x 0.13)/5, its half width 0.5/sqrt(625 + 2500).
  EXPECT_NEAR(found[0].parameters[0].estimate.value, 0.124, 1e-12);
  EXPECT_NEAR(found[0].parameters[0].estimate.ci95.high, 0.124 + 0.5 / std::sqrt(3125.0), 1e-12);
}

TEST(JoinAxes, CausesWithAValuePerAxisStayApart) {
  const Cause& own = cause_with(false);
  std::vector<Evidence> found{on_axis(own, 0, 0.1, 0.02), on_axis(own, 1, 0.1, 0.02),
                              on_axis(cause_with(true), 2, 0.1, 0.02)};
  join_axes(found);
  EXPECT_EQ(found.size(), 3U);
}

}  // namespace
}  // namespace driftlab::investigate
