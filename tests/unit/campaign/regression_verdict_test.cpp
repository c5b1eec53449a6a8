// The claims of a regression run on simulated devices. The full figures are those of
// tests/accuracy/regression_test.cpp; here the goals are held at sizes that take seconds. Seeds were fixed before
// looking.
#include "core/campaign/regression/ratios.hpp"
#include "core/campaign/regression/verdict.hpp"
#include "tests/accuracy/regression_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

using accuracy::Rig;
using accuracy::run_many;
using accuracy::Shares;
using regression::Row;

double unchanged(const Row& /*row*/) { return 0.0; }

TEST(RegressionVerdict, FailsAnUnchangedDeviceSeldom) {
  const Rig rig(300.0);
  // At a true share of 5 % more than 9 % of 120 runs come in 2 % of the tests; the measured share is below 1 %.
  const Shares three = run_many(rig, {3, 3, 0}, unchanged, 120, 1);
  EXPECT_LE(three.percent(three.fail), 5.0);
  EXPECT_GE(three.percent(three.pass), 60.0);
  const Shares one = run_many(rig, {1, 1, 0}, unchanged, 60, 2);
  EXPECT_LE(one.percent(one.fail), 8.0);
}

TEST(RegressionVerdict, SeldomPassesADeviceAtItsMarginAndSeldomFailsIt) {
  const Rig rig(300.0);
  const Shares at_one = run_many(
      rig, {3, 3, 0}, [](const Row& row) { return row.unit == 2 && row.octave == 3 ? row.margin : std::log(0.7); }, 80,
      3);
  EXPECT_LE(at_one.percent(at_one.pass), 10.0);  // 5 % goal; above 10 % in 2 % of the tests of 80 runs
  const Shares at_all = run_many(rig, {3, 3, 0}, [](const Row& row) { return row.margin; }, 80, 4);
  EXPECT_LE(at_all.percent(at_all.fail), 10.0);
}

TEST(RegressionVerdict, SeesWhiteNoiseThatGrewByHalf) {
  const Rig rig(300.0);
  const auto grown = [&](const Row& row) {
    const double m = std::exp2(row.octave);
    return row.unit == 1 ? 0.5 * std::log(1.0 + 1.25 * rig.white(m) / rig.variance(m)) : 0.0;
  };
  const Shares shares = run_many(rig, {3, 3, 0}, grown, 40, 5);
  EXPECT_GE(shares.percent(shares.fail), 95.0);
}

TEST(RegressionVerdict, DoesNotDependOnTheOrderOfTheSessions) {
  const Rig rig(120.0);
  Random random(6);
  regression::Design design = rig.draw(random, 2, 3, 2, unchanged);
  const regression::Comparison before = regression::compare(design, {});
  std::swap(design.sessions[2], design.sessions[4]);
  std::swap(design.sessions[0], design.sessions[1]);
  const regression::Comparison after = regression::compare(design, {});
  ASSERT_EQ(before.outcomes.size(), after.outcomes.size());
  EXPECT_EQ(before.verdict, after.verdict);
  EXPECT_NEAR(before.c_max, after.c_max, 1e-9);
  for (std::size_t t = 0; t < before.outcomes.size(); ++t) {
    EXPECT_NEAR(before.outcomes[t].lower, after.outcomes[t].lower, 1e-9);
  }
}

/// Where five sessions stand against one, five sixths of what sessions add to the difference are that one's, with its
/// tails; in arms of equal size each has its part.
TEST(RegressionVerdict, ASessionThatStandsAloneCountsWithItsTails) {
  const Rig rig(120.0);
  Random random(10);
  regression::Design design = rig.draw(random, 5, 1, 2, unchanged);
  const regression::ScatterTerms terms = regression::scatter_terms(design);
  const regression::SessionScatter scatter = regression::learn_scatter(design, terms, 4.0);
  regression::Contrast contrast = regression::make_contrast(design, terms, scatter);
  ASSERT_EQ(contrast.shares.cols(), 6);
  ASSERT_EQ(contrast.shares.rows(), contrast.combine.cols());
  EXPECT_NEAR((contrast.shares.rowwise().sum().array() - 1.0).abs().maxCoeff(), 0.0, 1e-12);
  EXPECT_NEAR((contrast.shares.rowwise().maxCoeff().array() - 5.0 / 6.0).abs().maxCoeff(), 0.0, 1e-12);
  const double alone = regression::critical_values(contrast, scatter, {}).c_max;
  std::swap(design.sessions.front(), design.sessions[5]);  // the candidate first
  const regression::Contrast other = regression::make_contrast(design, terms, scatter);
  EXPECT_NEAR((other.shares - contrast.shares).cwiseAbs().maxCoeff(), 0.0, 1e-12);
  contrast.shares.setConstant(1.0 / 6.0);
  EXPECT_GT(alone, 1.02 * regression::critical_values(contrast, scatter, {}).c_max);
}

TEST(RegressionVerdict, LearnsARestlessRigFromItsSessionsAndRestsOnThePriorWithoutThem) {
  const Rig rig(300.0);
  Random random(7);
  const regression::Design one = rig.draw(random, 1, 1, 0, unchanged, 3.0);
  const regression::Design many = rig.draw(random, 5, 5, 0, unchanged, 3.0);
  const auto scatter = [](const regression::Design& design) {
    return regression::learn_scatter(design, regression::scatter_terms(design), 4.0);
  };
  EXPECT_EQ(scatter(one).contrasts, 0U);
  EXPECT_EQ(scatter(many).contrasts, 8U);
  EXPECT_LT(std::sqrt(scatter(one).mean_square_local()), 2.0);
  EXPECT_GT(std::sqrt(scatter(many).mean_square_local()), 2.0);
  const regression::ScatterFactors told = regression::factors_of(scatter(many));
  EXPECT_EQ(told.local.value, std::sqrt(scatter(many).mean_square_local()));
  EXPECT_EQ(told.local.ci95.low, scatter(many).quantile_local(0.025));
  EXPECT_EQ(told.local.ci95.high, scatter(many).quantile_local(0.975));
  EXPECT_EQ(told.common.ci95.low, scatter(many).quantile_common(0.025));
  EXPECT_EQ(told.common.ci95.high, scatter(many).quantile_common(0.975));
}

TEST(RegressionVerdict, AsksForMoreSessionsWhereTheseDecideNothing) {
  const Rig rig(300.0);
  Random random(8);
  const regression::Comparison comparison = regression::compare(rig.draw(random, 1, 1, 0, unchanged), {});
  ASSERT_EQ(comparison.verdict, regression::Verdict::Inconclusive);
  ASSERT_TRUE(comparison.needs.sessions_per_arm);
  EXPECT_GE(*comparison.needs.sessions_per_arm, 2U);
  EXPECT_LE(*comparison.needs.sessions_per_arm, 12U);
  EXPECT_FALSE(comparison.needs.length_factor);  // the scatter of the sessions stays however long they are
}

TEST(RegressionVerdict, ComparesNoLevelsWhereTheStructureChanged) {
  const Rig rig(300.0);
  Random random(9);
  const regression::Comparison same = regression::compare(rig.draw(random, 3, 3, 0, unchanged), {});
  const auto levels = [](const regression::Comparison& comparison) {
    return std::count_if(comparison.contrast.tests.begin(), comparison.contrast.tests.end(),
                         [](const regression::Test& test) { return test.level.has_value(); });
  };
  EXPECT_GE(levels(same), 15);
  const auto bump = [](const Row& row) { return row.unit == 0 && row.octave == 4 ? 0.8 : 0.0; };
  const regression::Comparison changed = regression::compare(rig.draw(random, 3, 3, 0, bump), {});
  EXPECT_FALSE(changed.contrast.structures[0].compared);
  EXPECT_LT(changed.contrast.structures[0].p_contrast, 0.01);
  EXPECT_EQ(changed.contrast.structures[0].least_p(),
            std::min(changed.contrast.structures[0].p_fit, changed.contrast.structures[0].p_contrast));
  EXPECT_EQ(changed.verdict, regression::Verdict::Fail);  // its scales decide
}

}  // namespace
}  // namespace driftlab
