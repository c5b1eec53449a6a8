#include "core/fit/structure.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

StructureScore score(double criterion, double misfit = 10.0, double dof = 12.0) {
  return {true, criterion, misfit, dof};
}

TEST(Structure, SumsTheCriterionOverConditions) {
  // A wins one condition by 1, B the other by 5.
  const StructureChoice choice = choose_structure({"A", "B"}, {{score(1), score(2)}, {score(9), score(4)}});
  EXPECT_EQ(choice.best, 1U);
  EXPECT_EQ(choice.sum, (std::vector<double>{10.0, 6.0}));
  EXPECT_EQ(choice.by_condition, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(choice.statistic, 20.0);
  EXPECT_EQ(choice.dof, 24.0);
}

TEST(Structure, WeighsOneStructureAgainstManyAsTheFormulaSays) {
  // Two structures, two conditions, criteria 0 and d: one = ln(1/2 (1 + e^-d)), changing = 2 ln(1/2 (1 + e^(-d/2))).
  const double d = 3.0;
  const StructureChoice choice = choose_structure({"A", "B"}, {{score(0), score(d)}, {score(0), score(d)}});
  const double expected = 2.0 * (std::log(0.5 * (1.0 + std::exp(-d))) - 2.0 * std::log(0.5 * (1.0 + std::exp(-d / 2))));
  EXPECT_NEAR(choice.evidence, expected, 1e-12);
}

TEST(Structure, SaysOneStructureOnlyWhereItFits) {
  const std::vector<std::vector<StructureScore>> agree(5, {score(0), score(20), score(20)});
  const StructureChoice one = choose_structure({"A", "B", "C"}, agree);
  EXPECT_EQ(one.verdict, StructureVerdict::OneStructure);
  EXPECT_NE(one.statement.find("One structure, A"), std::string::npos);
  const std::vector<std::vector<StructureScore>> misfit(5, {score(0, 40.0), score(20), score(20)});
  const StructureChoice rejected = choose_structure({"A", "B", "C"}, misfit);
  EXPECT_LT(rejected.p, 0.001);
  EXPECT_EQ(rejected.verdict, StructureVerdict::Undecided);
}

TEST(Structure, SaysThatItChangesWhereTheConditionsWantDifferentOnes) {
  const StructureChoice choice =
      choose_structure({"A", "B"}, {{score(0), score(30)}, {score(30), score(0)}, {score(0), score(30)}});
  EXPECT_EQ(choice.verdict, StructureVerdict::Changes);
  EXPECT_EQ(name_of(choice.verdict), "changes");
}

TEST(Structure, LeavesOutWhatWasNotFittedEverywhere) {
  const StructureChoice choice = choose_structure({"A", "B"}, {{score(0), score(5)}, {StructureScore{}, score(5)}});
  EXPECT_EQ(choice.best, 1U);
  EXPECT_TRUE(std::isinf(choice.sum[0]));
  const StructureChoice alone = choose_structure({"A", "B"}, {{score(0), score(5)}});
  EXPECT_EQ(alone.verdict, StructureVerdict::Undecided);
  EXPECT_EQ(alone.evidence, 0.0);
}

}  // namespace
}  // namespace driftlab
