#include "core/campaign/structure.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

StructureScore score(double criterion, double misfit = 10.0, double dof = 12.0) {
  return {true, criterion, misfit, dof};
}

const std::vector<std::string> kNames{"WN", "WN+GM", "WN+DR", "WN+GM+DR"};

TEST(Structure, SumsTheCriterionOverConditions) {
  // WN wins one condition by 1, WN+GM the other by 5.
  const StructureChoice choice = choose_structure({"WN", "WN+GM"}, {{score(1), score(2)}, {score(9), score(4)}});
  EXPECT_EQ(choice.best, 1U);
  EXPECT_EQ(choice.sum, (std::vector<double>{10.0, 6.0}));
  EXPECT_EQ(choice.by_condition, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(choice.statistic, 20.0);
  EXPECT_EQ(choice.dof, 24.0);
}

TEST(Structure, AComponentThatFadesIsAParameterThatMoves) {
  const StructureChoice choice = choose_structure(
      kNames, {{score(0), score(24), score(12), score(36)}, {score(500), score(0), score(300), score(12)}});
  EXPECT_EQ(kNames[choice.common], "WN+GM");
  EXPECT_EQ(choice.excess, 0.0);
  EXPECT_EQ(choice.verdict, StructureVerdict::OneStructure);
  EXPECT_NE(choice.statement.find("not every condition shows all"), std::string::npos);
}

TEST(Structure, ComponentsThatNeverOccurTogetherAreAChange) {
  const StructureChoice choice = choose_structure(
      kNames, {{score(500), score(0), score(300), score(12)}, {score(500), score(300), score(0), score(24)}});
  EXPECT_EQ(kNames[choice.common], "WN+GM+DR");
  EXPECT_EQ(choice.excess, 12.0);
  EXPECT_EQ(choice.verdict, StructureVerdict::Changes);
  EXPECT_EQ(name_of(choice.verdict), "changes");
}

TEST(Structure, WhatTheDataHardlyTellApartIsNoChange) {
  // The second condition prefers a drift, but by less than 6.
  const StructureChoice choice = choose_structure(
      kNames, {{score(500), score(0), score(300), score(12)}, {score(500), score(5), score(0), score(17)}});
  EXPECT_EQ(kNames[choice.common], "WN+GM");
  EXPECT_EQ(choice.verdict, StructureVerdict::OneStructure);
}

TEST(Structure, ARandomWalkIsTheLimitOfAGaussMarkovProcess) {
  const StructureChoice choice =
      choose_structure({"WN", "WN+RW", "WN+GM", "WN+GM+RW"},
                       {{score(500), score(0), score(12), score(24)}, {score(500), score(300), score(0), score(12)}});
  EXPECT_EQ(choice.common, 2U);
  EXPECT_EQ(choice.verdict, StructureVerdict::OneStructure);
}

TEST(Structure, SaysSoWhereNoneFits) {
  const StructureChoice choice =
      choose_structure({"WN", "WN+GM"}, {{score(0, 40.0), score(20, 38.0)}, {score(0, 40.0), score(20, 38.0)}});
  EXPECT_LT(choice.p, 0.001);
  EXPECT_EQ(choice.verdict, StructureVerdict::Undecided);
  EXPECT_NE(choice.statement.find("does not fit (p < 0.01)"), std::string::npos) << choice.statement;
  EXPECT_NE(choice.statement.find("none of the candidates"), std::string::npos);
}

TEST(Structure, LeavesOutWhatWasNotFittedEverywhere) {
  const StructureChoice choice =
      choose_structure({"WN", "WN+GM"}, {{score(0), score(5)}, {StructureScore{}, score(5)}});
  EXPECT_EQ(choice.best, 1U);
  EXPECT_TRUE(std::isinf(choice.sum[0]));
  const StructureChoice alone = choose_structure({"WN", "WN+GM"}, {{score(0), score(5)}});
  EXPECT_EQ(alone.verdict, StructureVerdict::Undecided);
}

}  // namespace
}  // namespace driftlab
