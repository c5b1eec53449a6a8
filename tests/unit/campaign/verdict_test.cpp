// A model ranked first of nine was called the answer where none of the nine fits.
#include "core/campaign/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

using testing::HasSubstr;
using testing::Not;

ReportedFit fit_of(const std::string& model, double p) {
  ReportedFit fit;
  fit.model = model;
  fit.processes = {
      {"white_noise", {{"N", {1.9321, 1.90, 1.96, "deg/sqrt(h)", ""}}}},
      {"gauss_markov", {{"sigma", {62.4, 57.3, 68.2, "deg/h", ""}}, {"beta", {0.3234, 0.2401, 0.4302, "1/s", ""}}}}};
  fit.j_test = JTest{1.0, 10.0, p};
  return fit;
}

ReportedChannel channel_of(std::vector<ReportedFit> fits) {
  ReportedChannel channel;
  channel.fits = std::move(fits);
  return channel;
}

TEST(Verdict, NamesTheModelThatFitsWithFiguresTheirIntervalsLetStand) {
  const Verdict verdict = verdict_of(channel_of({fit_of("WN+GM", 0.2)}), {});
  EXPECT_EQ(
      verdict.sentence,
      "WN+GM describes this recording (J test p = 0.20): white noise of 1.93 deg/sqrt(h) and a Gauss-Markov bias of "
      "62 deg/h with a correlation time of 3.1 s.");
  EXPECT_EQ(verdict.level, VerdictLevel::Fine);
  EXPECT_EQ(verdict.facts.front().first, "/fits/0/j_test/p");
}

TEST(Verdict, SaysThatNoneFitsBeforeWhichIsBest) {
  const Verdict verdict = verdict_of(channel_of({fit_of("WN+GM", 0.001), fit_of("WN", 1e-9)}), {});
  EXPECT_THAT(verdict.sentence, HasSubstr("None of two candidates describes this recording (J test p < 0.01"));
  EXPECT_THAT(verdict.sentence, Not(HasSubstr("1.93")));
  EXPECT_EQ(verdict.level, VerdictLevel::Look);
}

TEST(Verdict, NamesTheModelThatFitsThoughAnotherIsRankedFirst) {
  const Verdict verdict = verdict_of(channel_of({fit_of("WN+GM+RW", 0.001), fit_of("WN+2GM", 0.3)}), {});
  EXPECT_THAT(verdict.sentence, HasSubstr("WN+GM+RW, ranked first by the criterion, does not fit"));
  EXPECT_THAT(verdict.sentence, HasSubstr("WN+2GM does (p = 0.30)"));
}

TEST(Verdict, SaysThatTheFirstOfTheRankingIsNotTheClosest) {
  // The criterion ranked first what is not in the plausible set, and the sentence said that others could not be told
  // from it.
  // L is 30 with three parameters and 13.66 with five: by L + p ln N the first wins, by L + 2p the second, by 12.34.
  ReportedFit first = fit_of("WN+GM", 0.2);
  ReportedFit second = fit_of("WN+2GM", 0.3);
  ReportedChannel channel = channel_of({});
  channel.samples = 100'000;
  const double ln = std::log(100'000.0);
  first.wic = 30.0 + 3.0 * ln;
  second.wic = 13.66 + 5.0 * ln;
  ASSERT_LT(first.wic, second.wic);
  second.plausible = true;
  channel.fits = {first, second};
  const Verdict verdict = verdict_of(channel, {});
  EXPECT_THAT(verdict.details, testing::Contains("WN+GM is ranked first by the criterion; WN+2GM is closer to the "
                                                 "data, by 12.3 in distance + 2p, of which 6 are chance."));
  EXPECT_THAT(verdict.details, Not(testing::Contains(HasSubstr("cannot tell"))));
  channel.fits[0].plausible = true;
  EXPECT_THAT(verdict_of(channel, {}).details,
              testing::Contains("One more model is plausible: the data cannot tell it from the best."));
}

TEST(Verdict, SaysAReasonOnceThoughTheFitWarnsOfItToo) {
  ReportedFit fit = fit_of("WN+GM", 0.2);
  fit.processes.front().parameters.front().second = {{}, {}, {}, "", "The best fit has none."};
  fit.warnings = {"The best fit has none.", "Something else."};
  const Verdict verdict = verdict_of(channel_of({fit}), {});
  EXPECT_THAT(verdict.details, testing::ElementsAre("N: The best fit has none.", "Something else."));
}

TEST(Verdict, SaysWhatGrossErrorsAndAnotherShapeDo) {
  ReportedChannel channel = channel_of({fit_of("WN+GM", 0.2)});
  EXPECT_THAT(verdict_of(channel, {true, 6, 18}).sentence, HasSubstr("The noise is not Gaussian"));
  EXPECT_THAT(verdict_of(channel, {true, 6, 18}).details, testing::Contains(HasSubstr("6 of 18 scales")));
  channel.contamination = "contaminated";
  EXPECT_THAT(verdict_of(channel, {}).sentence, HasSubstr("Gross errors move its variances"));
  EXPECT_EQ(verdict_of(channel_of({}), {}).level, VerdictLevel::Wrong);
}

/// A low-passed sensor at two rates: the model holds no white noise, and the table said "has no white noise" of a
/// sensor whose angle random walk stood in its own first column.
TEST(Verdict, OfATableIsAboutTheDensityThatRowsShowWhateverTheModel) {
  ParameterTable table{"phone", Quantity::AngularRate, "z", TableMethod::Gmwm, "2GM", {{"gauss_markov_1.beta", "1/s"}},
                       {}};
  for (const auto& [condition, value] : {std::pair("static", 0.3), std::pair("constant_rate:z:9:deg/s", 0.5)}) {
    TableRow row;
    row.condition = *parse_condition(condition);
    row.label = condition;
    row.cells = {{{1.7, 1.5, 1.9, "1/s", ""}, Change::None}};
    row.density = {{value, 0.99 * value, 1.01 * value, "deg/sqrt(h)", ""}, value > 0.4 ? Change::Up : Change::None};
    table.rows.push_back(row);
  }
  EXPECT_THAT(verdict_of(table).sentence,
              testing::StartsWith("The white-noise density N is 0.300 deg/sqrt(h) (static) and 0.500 deg/sqrt(h) at "
                                  "constant_rate:z:9:deg/s."));
  EXPECT_THAT(verdict_of(table).sentence, HasSubstr("It moves"));
  for (TableRow& row : table.rows) {
    row.density = {};
  }
  table.structure.emplace().statement = "One structure, 2GM, describes every condition.";
  table.model_note = "The table shows 2GM, as was asked.";
  EXPECT_THAT(verdict_of(table).sentence, HasSubstr("the model 2GM holds none"));
  EXPECT_THAT(verdict_of(table).details, testing::ElementsAre(table.structure->statement, table.model_note));
}

TEST(Verdict, OfSeveralTheGravestIsTheFirstOfTheWorstLevel) {
  const auto of = [](std::vector<VerdictLevel> levels) {
    std::vector<Verdict> verdicts(levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) {
      verdicts[i].level = levels[i];
    }
    return gravest_of(verdicts);
  };
  using enum VerdictLevel;
  EXPECT_EQ(of({Fine, Look, Wrong, Wrong, Look}), 2U);
  EXPECT_EQ(of({Fine, Fine}), 0U);
  EXPECT_EQ(of({}), std::nullopt);
}

TEST(Verdict, RestsOnWhatTheTestForGrossErrorsFound) {
  Contamination contamination;
  contamination.not_gaussian = true;
  contamination.disjoint_scales = {2, 4, 8};
  const GrossErrorEvidence evidence = evidence_of(contamination, 18);
  EXPECT_TRUE(evidence.not_gaussian);
  EXPECT_EQ(evidence.disjoint_scales, 3U);
  EXPECT_EQ(evidence.scales, 18U);
}

}  // namespace
}  // namespace driftlab
