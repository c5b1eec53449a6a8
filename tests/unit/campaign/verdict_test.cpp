// A model ranked first of nine was called the answer where none of the nine fits.
#include "core/campaign/verdict.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(Verdict, SaysWhatGrossErrorsAndAnotherShapeDo) {
  ReportedChannel channel = channel_of({fit_of("WN+GM", 0.2)});
  EXPECT_THAT(verdict_of(channel, {true, 6, 18}).sentence, HasSubstr("The noise is not Gaussian"));
  EXPECT_THAT(verdict_of(channel, {true, 6, 18}).details, testing::Contains(HasSubstr("6 of 18 scales")));
  channel.contamination = "contaminated";
  EXPECT_THAT(verdict_of(channel, {}).sentence, HasSubstr("Gross errors move its variances"));
  EXPECT_EQ(verdict_of(channel_of({}), {}).level, VerdictLevel::Wrong);
}

}  // namespace
}  // namespace driftlab
