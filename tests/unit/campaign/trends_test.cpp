#include "core/campaign/trends.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

/// A value whose 95 % interval is `relative` wide on either side of its logarithm.
TrendPoint point(double at, double value, double relative = 0.02) {
  const double factor = std::exp(1.959963984540054 * relative);
  return {at, {value, {value / factor, value * factor}}};
}

constexpr double kRates[] = {0.0, 9.0, 18.0, 36.0, 72.0, 120.0};

/// Share of 400 random series of six conditions in which `count` says yes. `spread`: between conditions; `slope`: of
/// ln value from the first to the last rank.
template <class Count>
double share(double spread, double slope, Count count) {
  constexpr int kRuns = 400;
  int hits = 0;
  for (int run = 0; run < kRuns; ++run) {
    Random random(31, static_cast<std::uint64_t>(run));
    std::vector<TrendPoint> points;
    for (int i = 0; i < 6; ++i) {
      points.push_back(point(kRates[i], std::exp(slope * i / 5.0 + 0.02 * random.normal() + spread * random.normal())));
    }
    hits += count(*fit_trend(points)) ? 1 : 0;
  }
  return static_cast<double>(hits) / kRuns;
}

TEST(Trend, EqualityHoldsItsSizeAndTheTrendDoesNotCryWolf) {
  // 400 runs: a 5 % share has a standard error of 1.1 points.
  const double moved = share(0.0, 0.0, [](const Trend& t) { return t.equal_p < 0.05; });
  EXPECT_NEAR(moved, 0.05, 0.033);
  EXPECT_LT(share(0.0, 0.0, [](const Trend& t) { return t.direction != 0; }), 0.08);
  // Conditions that differ at random by ten interval widths move, and have no trend.
  EXPECT_GT(share(0.3, 0.0, [](const Trend& t) { return t.equal_p < 0.05; }), 0.99);
  EXPECT_NEAR(share(0.3, 0.0, [](const Trend& t) { return t.direction != 0; }), 0.05, 0.033);
}

TEST(Trend, FindsAMonotoneChange) {
  EXPECT_GT(share(0.0, 0.3, [](const Trend& t) { return t.direction == 1; }), 0.95);
  EXPECT_GT(share(0.0, -0.3, [](const Trend& t) { return t.direction == -1; }), 0.95);
}

TEST(Trend, ChoosesTheRelationThatMadeTheData) {
  std::vector<TrendPoint> constant;
  std::vector<TrendPoint> linear;
  std::vector<TrendPoint> power;
  for (int i = 0; i < 10; ++i) {
    const double wiggle = std::exp(0.01 * ((i * 7) % 5 - 2));
    const double w = 10.0 * i;
    constant.push_back(point(w, 2.0 * wiggle));
    linear.push_back(point(w, (1.0 + 0.05 * w) * wiggle));
    power.push_back(point(w, (1.0 + 0.002 * w * w) * wiggle));
  }
  EXPECT_EQ(fit_trend(constant)->relation.relation, Relation::Constant);
  const Trend line = *fit_trend(linear);
  EXPECT_EQ(line.relation.relation, Relation::Linear);
  EXPECT_NEAR(line.relation(45.0), 3.25, 0.1);
  const Trend curve = *fit_trend(power);
  EXPECT_EQ(curve.relation.relation, Relation::Power);
  EXPECT_NEAR(curve.relation.exponent, 2.0, 0.25);
}

TEST(Trend, IntervalBetweenConditionsHoldsTheParameterThere) {
  // Linear truth with a spread of 10 %; the parameter at an unmeasured rate has the same spread. Six points leave four
  // degrees of freedom and the relation is chosen: the promise is 90 %, not 95.
  constexpr int kRuns = 400;
  int inside = 0;
  for (int run = 0; run < kRuns; ++run) {
    Random random(32, static_cast<std::uint64_t>(run));
    const auto truth = [&](double w) { return (1.0 + 0.02 * w) * std::exp(0.1 * random.normal()); };
    std::vector<TrendPoint> points;
    for (const double w : kRates) {
      points.push_back(point(w, truth(w) * std::exp(0.02 * random.normal())));
    }
    inside += value_at(*fit_trend(points), 54.0).estimate.ci95.contains(truth(54.0)) ? 1 : 0;
  }
  EXPECT_GT(inside, 360);
}

TEST(Trend, ClampsOutsideTheMeasuredRangeAndSaysSo) {
  const Trend trend = *fit_trend({point(1.0, 1.0), point(2.0, 2.0)});
  EXPECT_EQ(trend.relation.relation, Relation::Linear);
  EXPECT_TRUE(trend.few);
  EXPECT_EQ(trend.direction, 1);
  const Interpolated beyond = value_at(trend, -5.0);
  EXPECT_TRUE(beyond.outside);
  EXPECT_NEAR(beyond.estimate.value, 2.0, 1e-4);
  // The fit stops at a part in 10^10 of its distance: 10^-5 of an interval width.
  EXPECT_NEAR(value_at(trend, 1.5).estimate.value, 1.5, 1e-4);
  EXPECT_FALSE(value_at(trend, 1.5).outside);
}

TEST(Trend, TwoEqualConditionsAreConstant) {
  const Trend trend = *fit_trend({point(0.0, 1.0), point(9.0, 1.01)});
  EXPECT_EQ(trend.direction, 0);
  EXPECT_EQ(trend.relation.relation, Relation::Constant);
}

TEST(Trend, RefusesOneConditionAndOpenIntervals) {
  EXPECT_EQ(fit_trend({point(3.0, 1.0), point(3.0, 2.0)}).error().code, ErrorCode::TooFewSamples);
  TrendPoint open = point(0.0, 1.0);
  open.estimate.ci95.high = std::numeric_limits<double>::infinity();
  EXPECT_EQ(fit_trend({open, point(3.0, 2.0)}).error().code, ErrorCode::InvalidArgument);
}

}  // namespace
}  // namespace driftlab
