// The sentence of an outage evaluation says no more than its intervals do.
#include "core/analysis/outage_verdict.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

struct Told {
  const char* name;
  double error_m;
  double coverage95;
  double nees;
};

/// Filters with errors after outages of 10 s and, of every pair, the difference with this half-width.
OutageEvaluation evaluation_of(const std::vector<Told>& filters, double half_width_m) {
  OutageEvaluation evaluation;
  for (const Told& told : filters) {
    FilterEvaluation filter;
    filter.name = told.name;
    filter.mean_error_m = {told.error_m, {told.error_m - 0.2, told.error_m + 0.2}};
    filter.coverage95 = told.coverage95;
    filter.nees = {told.nees, {told.nees - 0.1, told.nees + 0.1}};
    filter.outages.resize(1);
    filter.outages.front().start_s = 30.0;
    filter.outages.front().end_s = 40.0;
    evaluation.filters.push_back(filter);
    for (const Told& other : filters) {
      if (&other != &told) {
        const double gap = told.error_m - other.error_m;
        const Estimate relative{gap / other.error_m,
                                {(gap - half_width_m) / other.error_m, (gap + half_width_m) / other.error_m}};
        evaluation.paired.push_back(
            {told.name, other.name, {gap, {gap - half_width_m, gap + half_width_m}}, relative, {}});
      }
    }
  }
  return evaluation;
}

TEST(OutageVerdict, NamesTheGainWithItsIntervalAndHowHonestTheBestFilterIs) {
  const Verdict verdict = verdict_of(
      evaluation_of({{"M_stat(AV)", 8.0, 0.31, 25.0}, {"worst", 9.0, 0.3, 30.0}, {"best", 5.0, 0.94, 2.1}}, 0.4),
      std::nullopt, {});
  EXPECT_EQ(
      verdict.sentence,
      "best lowers the mean error after 10 s without GNSS from 8.0 m to 5.0 m, by 38 % [33, 43]; its 95 % ellipse "
      "holds the truth in 94 % of outages.");
  EXPECT_EQ(verdict.level, VerdictLevel::Fine);
  ASSERT_EQ(verdict.details.size(), 1U);
  EXPECT_EQ(verdict.details.front(),
            "The 95 % ellipse of M_stat(AV) holds the truth in 31 % of outages; NEES is 2.10 [2.00, 2.20] for best and "
            "25.00 [24.90, 25.10] for M_stat(AV), and 2 is right.");
  // Pairs come filter by filter: those of the third begin after two of each of the others.
  EXPECT_EQ(verdict.facts.front().first, "/filters/2/mean_error_m/value");
  EXPECT_EQ(verdict.facts.back().first, "/paired/4/relative/value");
  EXPECT_DOUBLE_EQ(verdict.facts.back().second, -3.0 / 8.0);
}

TEST(OutageVerdict, ClaimsNoGainThatTheIntervalDoesNotExclude) {
  const Verdict verdict =
      verdict_of(evaluation_of({{"M_stat(AV)", 8.0, 0.95, 2.0}, {"other", 7.9, 0.95, 2.0}}, 0.4), std::nullopt, {});
  EXPECT_EQ(verdict.sentence,
            "other is 7.9 m off after 10 s without GNSS and cannot be told from M_stat(AV); its 95 % ellipse holds the "
            "truth in 95 % of outages.");
}

TEST(OutageVerdict, CallsAGainBelowOnePerCentWhatItIs) {
  const Verdict verdict =
      verdict_of(evaluation_of({{"M_stat(AV)", 8.0, 0.95, 2.0}, {"other", 7.95, 0.95, 2.0}}, 0.01), std::nullopt, {});
  EXPECT_NE(verdict.sentence.find("less than 1 % better than M_stat(AV)"), std::string::npos) << verdict.sentence;
}

TEST(OutageVerdict, SaysOfAFilterThatItDoesNotKnowItsError) {
  const Verdict sure = verdict_of(evaluation_of({{"a", 8.0, 0.3, 25.0}, {"b", 5.0, 0.5, 9.0}}, 0.1), std::nullopt, {});
  EXPECT_TRUE(sure.sentence.ends_with("in 50 % of outages: it is too sure of itself.")) << sure.sentence;
  EXPECT_EQ(sure.level, VerdictLevel::Look);
  const Verdict shy = verdict_of(evaluation_of({{"a", 8.0, 0.99, 0.5}}, 0.1), std::nullopt, {});
  EXPECT_EQ(
      shy.sentence,
      "a is 8.0 m off after 10 s without GNSS; its 95 % ellipse holds the truth in 99 % of outages, and is larger "
      "than it need be.");
}

TEST(OutageVerdict, SaysThatNothingBeatsTheUsualFilter) {
  const Verdict verdict =
      verdict_of(evaluation_of({{"M_stat(AV)", 4.0, 0.95, 2.0}, {"b", 5.0, 0.95, 2.0}}, 0.1), std::nullopt, {});
  EXPECT_TRUE(verdict.sentence.starts_with("No filter is better than M_stat(AV), which is 4.0 m off"))
      << verdict.sentence;
}

TEST(OutageVerdict, SharesOutTheGainAndCountsTheClaims) {
  const auto pair = [](double gain) { return PairedDifference{"", "", {gain, {gain - 0.1, gain + 0.1}}, {}, {}}; };
  const Attribution parts{pair(-3.0), pair(-1.0), pair(-1.5), pair(-0.5), pair(0.0)};
  const Verdict verdict = verdict_of(evaluation_of({{"a", 8.0, 0.95, 2.0}, {"b", 5.0, 0.95, 2.0}}, 0.1), parts,
                                     {{"one", true, ""}, {"two", false, ""}});
  ASSERT_EQ(verdict.details.size(), 3U);
  EXPECT_EQ(verdict.details[1],
            "Of the change of -3.00 m [-3.10, -2.90], -1.00 m [-1.10, -0.90] come from telling the filter of "
            "low-frequency noise, -1.50 m [-1.60, -1.40] from Gauss-Markov states and -0.50 m [-0.60, -0.40] from "
            "following the rate.");
  EXPECT_EQ(verdict.details[2], "Of the paper's 2 claims this simulation supports 1.");
}

}  // namespace
}  // namespace driftlab
