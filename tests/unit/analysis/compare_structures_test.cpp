#include "core/analysis/compare_structures.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace driftlab {
namespace {

ReportedFit fit(const std::string& model, double criterion, double statistic = 10.0) {
  ReportedFit made;
  made.model = model;
  made.wic = criterion;
  made.j_test = JTest{.statistic = statistic, .dof = 12.0, .p = 0.6};
  return made;
}

TEST(CompareStructures, RecordingsThatCannotBeToldApartHaveOneStructure) {
  // Ranked first are two models, of which the one is as good as the other in both recordings.
  const PooledStructure told = compare_structures(
      {{"a", {fit("WN+GM", 0.0), fit("WN+RW", 1.0)}}, {"b", {fit("WN+RW", 0.0), fit("WN+GM", 1.0)}}});
  EXPECT_EQ(told.verdict, "one_structure");
  EXPECT_EQ(told.statement.find("They have one structure: WN+"), 0U) << told.statement;
  EXPECT_EQ(told.by_condition[0].label, "a");
  EXPECT_EQ(told.by_condition[1].model, "WN+RW");
}

TEST(CompareStructures, ComponentsThatNoRecordingShowsTogetherAreADifference) {
  const auto row = [](const std::string& label, double gauss_markov, double drift, double both) {
    return FittedRow{label, {fit("WN+GM", gauss_markov), fit("WN+DR", drift), fit("WN+GM+DR", both)}};
  };
  const PooledStructure told = compare_structures({row("a", 0.0, 300.0, 12.0), row("b", 300.0, 0.0, 24.0)});
  EXPECT_EQ(told.verdict, "changes");
  EXPECT_EQ(
      told.statement,
      "The structures differ: WN+GM+DR would serve all, but no recording shows its components together (criterion "
      "worse by 12.0 or more).");
}

TEST(CompareStructures, OnlyWhatEachWasFittedWithIsCompared) {
  const PooledStructure told =
      compare_structures({{"a", {fit("WN", 0.0), fit("WN+GM", -50.0)}}, {"b", {fit("WN", 0.0)}}});
  EXPECT_EQ(told.common, "WN");
  ASSERT_EQ(told.ranking.size(), 1U);
  EXPECT_EQ(compare_structures({{"a", {fit("WN", 0.0)}}, {"b", {fit("WN+GM", 0.0)}}}).statement,
            "No structure was fitted to every recording.");
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(compare_structures({{"a", {fit("WN", nothing)}}, {"b", {fit("WN", 0.0)}}}).verdict, "undecided");
}

}  // namespace
}  // namespace driftlab
