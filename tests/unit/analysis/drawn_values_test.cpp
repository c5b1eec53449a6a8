#include "core/analysis/drawn_values.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

/// y = 3 x^-1/2 at powers of four.
DrawnCurve falling() {
  DrawnCurve curve;
  for (int i = 0; i < 6; ++i) {
    const double x = 0.01 * std::pow(4.0, i);
    curve.x.push_back(x);
    curve.y.emplace_back(3.0 / std::sqrt(x));
  }
  return curve;
}

TEST(ReadAt, IsExactOnAPowerLawBetweenItsPointsAndSilentOutsideThem) {
  const DrawnCurve curve = falling();
  for (const double x : {0.01, 0.02, 0.16, 1.0, 10.0}) {
    const auto found = read_at(curve, x);
    ASSERT_TRUE(found) << x;
    EXPECT_NEAR(*found, 3.0 / std::sqrt(x), 1e-13 / std::sqrt(x)) << x;
  }
  EXPECT_EQ(read_at(curve, 0.16), curve.y[2]) << "at a point its own value, to the bit";
  EXPECT_EQ(read_at(curve, 0.0099), std::nullopt);
  EXPECT_EQ(read_at(curve, 11.0), std::nullopt);
  EXPECT_EQ(read_at({}, 1.0), std::nullopt);
}

TEST(ReadAt, DoesNotReachOverAValueThatIsNotKnown) {
  DrawnCurve curve = falling();
  curve.y[2].reset();  // 0.16
  EXPECT_EQ(read_at(curve, 0.3), std::nullopt);
  EXPECT_TRUE(read_at(curve, 0.03));
  EXPECT_TRUE(read_at(curve, 1.0));
}

TEST(RelativeTo, TakesTheModelAtTheMeasuredTimesBeforeItReadsItOff) {
  const DrawnCurve model = falling();
  const DrawnCurve measured{{0.01, 0.02, 20.0}, {60.0, std::nullopt, 1.0}, {30.0, 1.0, 1.0}, {90.0, 2.0, 1.0}};
  const DrawnCurve exact{{0.01}, {20.0}, {}, {}};
  const DrawnCurve ratio = relative_to(measured, exact, model);
  EXPECT_EQ(ratio.x, measured.x);
  EXPECT_EQ(ratio.y, (Values{3.0, std::nullopt, std::nullopt}));
  EXPECT_EQ(ratio.low[0], 1.5);
  EXPECT_EQ(ratio.high[0], 4.5);
  EXPECT_NEAR(ratio.low[1].value_or(0.0), std::sqrt(0.02) / 3.0, 1e-15);
}

TEST(DeviationsOfWavelets, AreThoseOfTwiceTheVariance) {
  const std::vector<std::size_t> scales{2, 4};
  const DrawnCurve found =
      deviations_of_wavelets(scales, 0.01, 10.0, {{}, {8.0, -1.0}, {2.0, 0.0}, {18.0, std::nullopt}});
  EXPECT_EQ(found.x, (std::vector{0.01, 0.02}));
  EXPECT_NEAR(found.y[0].value_or(0.0), 40.0, 1e-13);
  EXPECT_EQ(found.y[1], std::nullopt);
  EXPECT_NEAR(found.low[0].value_or(0.0), 20.0, 1e-13);
  EXPECT_EQ(found.low[1], 0.0);
  EXPECT_NEAR(found.high[0].value_or(0.0), 60.0, 1e-13);
  EXPECT_EQ(found.high[1], std::nullopt);
}

TEST(DrawnUnit, IsThatOfBiasInstability) {
  const DrawnUnit rate = drawn_unit("rad/s");
  EXPECT_EQ(rate.symbol, "deg/h");
  EXPECT_NEAR(rate.factor, 180.0 / std::numbers::pi * 3600.0, 1e-9);
  EXPECT_EQ(drawn_unit("m/s^2").symbol, "mg");
  EXPECT_NEAR(drawn_unit("m/s^2").factor, 1000.0 / 9.80665, 1e-12);
  EXPECT_EQ(drawn_unit("degC").symbol, "degC");
  EXPECT_EQ(drawn_unit("degC").factor, 1.0);
  // B of 2 deg/h is drawn at its floor, whatever the channel's unit.
  EXPECT_NEAR(bias_floor(2.0, *parse_unit("deg/s"), drawn_unit("deg/s")),
              2.0 * std::sqrt(2.0 * std::numbers::ln2 / std::numbers::pi), 2e-3);
  EXPECT_NEAR(bias_floor(2.0, *parse_unit("deg/s"), drawn_unit("deg/s")),
              bias_floor(2.0, *parse_unit("rad/s"), drawn_unit("rad/s")), 1e-12);
}

TEST(Ratios, EndWhereTheFarthestIs) {
  const Values ratios{1.1, 0.5, std::nullopt, 0.0, -3.0};
  EXPECT_DOUBLE_EQ(farthest_log(ratios, 0.1), std::numbers::ln2);
  EXPECT_EQ(farthest_log(ratios, 2.0), 2.0);
  EXPECT_DOUBLE_EQ(end_of_ratios(std::numbers::ln2, 2.0), 4.0);
  EXPECT_EQ(end_of_ratios(std::numbers::ln2, 2.0, 3.0), 3.0);
  EXPECT_DOUBLE_EQ(reach_of_ratios(ratios, 1.1, 1.5), 2.2);
  EXPECT_EQ(reach_of_ratios({}, 1.1, 1.5), 1.5);
  EXPECT_EQ(over({2.0, 1.0, std::nullopt, 1.0}, {4.0, 0.0, 1.0, std::nullopt}),
            (Values{0.5, std::nullopt, std::nullopt, std::nullopt}));
}

TEST(LevelPlace, IsWhereTheCurveOfAProcessEqualsItsLevel) {
  // Allan deviations of N = 3 and K = 2: N/sqrt(tau) and K sqrt(tau/3), straight lines on both logarithms.
  const std::vector<double> tau{0.01, 0.16, 2.56, 40.96};
  DrawnCurve white{tau, {}, {}, {}};
  DrawnCurve walk{tau, {}, {}, {}};
  for (const double t : tau) {
    white.y.emplace_back(3.0 / std::sqrt(t));
    walk.y.emplace_back(2.0 * std::sqrt(t / 3.0));
  }
  const auto n = level_place("white_noise", white, tau);
  ASSERT_TRUE(n);
  EXPECT_EQ(n->tau_s, 1.0);
  EXPECT_NEAR(n->deviation, 3.0, 1e-12);
  const auto k = level_place("random_walk", walk, tau);
  ASSERT_TRUE(k);
  EXPECT_EQ(k->tau_s, 3.0);
  EXPECT_NEAR(k->deviation, 2.0, 1e-12);
  EXPECT_FALSE(level_place("gauss_markov", white, tau));
  EXPECT_FALSE(level_place("random_walk", walk, std::vector{0.01, 2.0})) << "the record is too short to read it off";
  EXPECT_FALSE(level_place("white_noise", white, std::vector{2.0, 8.0}));
}

TEST(RobustDiffers, WhereAScaleDiffersOrGrossErrorsMoveTheVariances) {
  Contamination contamination;
  EXPECT_FALSE(robust_differs(contamination));
  contamination.disjoint_scales = {8};
  EXPECT_TRUE(robust_differs(contamination));
  contamination.disjoint_scales.clear();
  contamination.verdict = "contaminated";
  EXPECT_TRUE(robust_differs(contamination));
}

}  // namespace
}  // namespace driftlab
