#include "core/analysis/drive_verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftlab {
namespace {

drive::DurationSummary outages_of(double seconds, double held) {
  drive::DurationSummary summary;
  summary.duration_s = seconds;
  summary.rms_m.value = 3.0;
  summary.promised_rms_m = 1.5;
  summary.outages.resize(4);
  summary.coverage95.value = held;
  return summary;
}

TEST(DriveVerdict, IsTheFirstSentenceOfTheAnswer) {
  DriveSimulationReport report;
  report.measured.evaluation.durations = {outages_of(10.0, 0.96)};
  report.simulated.resize(1);
  report.simulated.front().duration_s = 10.0;
  const Verdict verdict = verdict_of(DriveAnswer(report));
  EXPECT_THAT(verdict.sentence, testing::StartsWith("After 10 s without fixes the measured error is"));
  EXPECT_THAT(verdict.sentence, testing::EndsWith("m against 0 m."));
  EXPECT_THAT(verdict.details, testing::ElementsAre(testing::StartsWith("The filter's 95 % ellipse holds")));
  EXPECT_EQ(verdict.level, VerdictLevel::Fine);
}

TEST(DriveVerdict, WantsALookWhereTheFilterIsTooSureOfItselfAtAnyLength) {
  DriveReport report;
  report.evaluation.durations = {outages_of(5.0, 0.95), outages_of(30.0, 0.7)};
  const Verdict verdict = verdict_of(DriveAnswer(report));
  EXPECT_EQ(verdict.level, VerdictLevel::Look);
  EXPECT_THAT(verdict.sentence, testing::HasSubstr("3 m off (rms of 4 measured outages"));
  EXPECT_TRUE(verdict.details.empty());
}

TEST(DriveVerdict, OfSeveralModelsOneThatKnowsItselfIsEnough) {
  DriveComparisonReport report;
  report.comparison.filters.resize(2);
  for (drive::ComparedFilter& filter : report.comparison.filters) {
    filter.durations = {outages_of(10.0, 0.6)};
  }
  EXPECT_EQ(verdict_of(DriveAnswer(report)).level, VerdictLevel::Look);
  report.comparison.filters.back().durations = {outages_of(10.0, 0.95)};
  EXPECT_EQ(verdict_of(DriveAnswer(report)).level, VerdictLevel::Fine);
}

}  // namespace
}  // namespace driftlab
