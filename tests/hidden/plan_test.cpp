/// A plan once could only repeat what a cause needs; here the recording that it proposes is made, and decides as often
/// as the plan says.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/investigate.hpp"
#include "core/investigate/plan_campaign.hpp"
#include "core/investigate/proposed_recordings.hpp"
#include "core/investigate/simulated_campaign.hpp"
#include "tests/hidden/simulated_study.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace driftlab::hidden {
namespace {

using namespace investigate;

/// A gyroscope of which only rest has been recorded.
SimulatedStudy at_rest(const std::vector<Hidden>& effects) {
  World world;
  world.scenario = Scenario::Static;
  world.given = true;
  world.rate_hz = 25.0;
  world.duration_s = 200.0;
  world.seed = 61;
  return simulate_study(world, effects);
}

TEST(Plan, AProposedRecordingDecidesInTheStatedShare) {
  const SimulatedStudy seen = at_rest({});
  const auto report = investigate::investigate(seen.study, {.predict_outages = false});
  ASSERT_TRUE(report);
  // Of all that rest cannot show, one question: is the scale factor wrong?
  Report asked = *report;
  std::erase_if(asked.not_examined, [](const NotExamined& item) { return item.cause != "scale_factor_error"; });
  ASSERT_EQ(asked.not_examined.size(), 1U);
  constexpr std::size_t kRuns = 6;
  const auto plan = plan_campaign(seen.study, asked, {.runs = kRuns, .seed = 3});
  ASSERT_TRUE(plan);
  ASSERT_EQ(plan->open.size(), 1U);
  ASSERT_FALSE(plan->proposals.empty());
  const Proposal& best = plan->proposals.front();
  ASSERT_EQ(best.decisions.size(), 1U);
  EXPECT_EQ(best.decisions[0].runs, kRuns);
  EXPECT_GT(best.decisions[0].decided, 0U) << best.title;
  EXPECT_FALSE(best.conditions.empty());
  // The proposal is played with the same sizes by other noise: its share lies within what the plan's interval allows.
  const ChannelGroup group = group_channels(seen.study).front();
  std::deque<std::vector<double>> memory;
  const auto proposals = proposed_recordings(group, memory);
  const auto chosen = std::find_if(proposals.begin(), proposals.end(),
                                   [&](const ProposedRecordings& proposal) { return proposal.title == best.title; });
  ASSERT_NE(chosen, proposals.end());
  const SimulatedCampaign campaign(seen.study, asked, group, chosen->blank);
  const std::vector<Answer> answers = campaign.answers_to(plan->open[0]);
  ASSERT_EQ(answers.size(), 1U);
  std::size_t decided = 0;
  for (std::uint64_t run = 0; run < kRuns; ++run) {
    const auto played = campaign.simulate(answers[0], 700000 + 1000 * run);
    const auto again = investigate::investigate(played.study, {.predict_outages = false});
    ASSERT_TRUE(again);
    decided += std::any_of(again->findings.begin(), again->findings.end(),
                           [](const Finding& finding) {
                             return finding.evidence.cause->name == "scale_factor_error" && !finding.evidence.ambiguous;
                           })
                   ? 1
                   : 0;
  }
  // Both shares are of six: they may differ by what two binomial draws do, Wilson's interval widened by its own half.
  const Interval& ci = best.decisions[0].probability.ci95;
  const double half = 0.5 * (ci.high - ci.low);
  const double share = static_cast<double>(decided) / kRuns;
  EXPECT_GE(share, ci.low - half);
  EXPECT_LE(share, ci.high + half);
}

TEST(Plan, TheSameSeedGivesTheSamePlanAndNothingOpenGivesNone) {
  const SimulatedStudy seen = at_rest({});
  auto report = investigate::investigate(seen.study, {.predict_outages = false});
  ASSERT_TRUE(report);
  std::erase_if(report->not_examined, [](const NotExamined& item) { return item.cause != "temperature_bias"; });
  const PlanOptions once{.runs = 1, .seed = 5};
  const auto a = plan_campaign(seen.study, *report, once);
  const auto b = plan_campaign(seen.study, *report, once);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->proposals.size(), b->proposals.size());
  for (std::size_t i = 0; i < a->proposals.size(); ++i) {
    EXPECT_EQ(a->proposals[i].title, b->proposals[i].title);
    EXPECT_EQ(a->proposals[i].expected(), b->proposals[i].expected());
  }
  ASSERT_FALSE(a->proposals.empty());
  EXPECT_NE(std::find(a->proposals.front().columns.begin(), a->proposals.front().columns.end(), "temperature"),
            a->proposals.front().columns.end());
  report->not_examined.clear();
  const auto none = plan_campaign(seen.study, *report, once);
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->open.empty());
  EXPECT_TRUE(none->proposals.empty());
}

}  // namespace
}  // namespace driftlab::hidden
