// What a regression run takes from the quality of a file and the test for gross errors of a channel.
#include "core/campaign/regression/recordings.hpp"

#include <gtest/gtest.h>

namespace driftlab::regression {
namespace {

Quality quality() {
  Quality quality;
  quality.samples = 15000;
  quality.missing = 12;
  quality.jitter_s = 1e-4;
  ChannelQuality channel;
  channel.column = "gz";
  channel.missing = 3;
  channel.implausible = 4;
  channel.repeated = 30;
  channel.resolution = 0.01;
  channel.saturated = 2;
  channel.frozen = 50;
  quality.channels = {channel};
  return quality;
}

TEST(FactsOf, CountsWhatStandsForNoNumberAsMissing) {
  const ChannelFacts facts = facts_of(quality(), "gz", std::nullopt);
  EXPECT_EQ(facts.samples, 15000U);
  EXPECT_EQ(facts.missing, 7U);
  EXPECT_EQ(facts.repeated, 30U);
  EXPECT_EQ(facts.frozen, 50U);
  EXPECT_EQ(facts.saturated, 2U);
  EXPECT_EQ(facts.resolution, 0.01);
  EXPECT_EQ(facts.bursts, 0U);
  EXPECT_FALSE(facts.mean);
}

TEST(FactsOf, KnowsTheFileWhereItDoesNotKnowTheColumn) {
  const ChannelFacts facts = facts_of(quality(), "gx", std::nullopt);
  EXPECT_EQ(facts.samples, 15000U);
  EXPECT_EQ(facts.missing, 0U);
  EXPECT_EQ(facts.resolution, 0.0);
}

TEST(FactsOf, TakesEachFlaggedSampleForABurstWhereBurstsWereNotCounted) {
  Contamination contamination;
  contamination.flagged_samples = 40;
  EXPECT_EQ(facts_of(quality(), "gz", contamination).bursts, 40U);
  contamination.bursts = 6;
  EXPECT_EQ(facts_of(quality(), "gz", contamination).bursts, 6U);
  contamination.bursts = 0;
  EXPECT_EQ(facts_of(quality(), "gz", contamination).bursts, 0U);
}

TEST(ComparedRecording, TakesOverTheRateThatSomebodyDeclared) {
  ComparedRecording recording;
  recording.rate_hz = 50.2;
  recording.tell(quality());
  EXPECT_EQ(recording.declared_hz, 50.2) << "no time stamps: the rate in use was declared";
  EXPECT_EQ(recording.samples, 15000U);
  EXPECT_EQ(recording.missing, 12U);
  EXPECT_EQ(recording.jitter_s, 1e-4);
  Quality stamped = quality();
  stamped.measured_rate_hz = 50.2;
  recording.tell(stamped);
  EXPECT_FALSE(recording.declared_hz) << "stamps alone";
  stamped.clock_ratio = 1.004;
  recording.tell(stamped);
  EXPECT_DOUBLE_EQ(recording.declared_hz.value_or(0.0), 50.0);
}

TEST(ComparedRecording, LastsAsLongAsItsGridWithWhatIsMissing) {
  ComparedRecording recording;
  recording.channels.resize(1);
  recording.channels.front().result.dt_s = 0.02;
  recording.channels.front().result.samples = 990;
  recording.channels.front().result.missing = 10;
  recording.time_by_channels();
  EXPECT_DOUBLE_EQ(recording.rate_hz, 50.0);
  EXPECT_DOUBLE_EQ(recording.duration_s, 20.0);
}

}  // namespace
}  // namespace driftlab::regression
