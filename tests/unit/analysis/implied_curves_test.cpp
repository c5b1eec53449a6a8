#include "core/analysis/implied_curves.hpp"

#include "core/process/registry.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

TEST(ImpliedBeside, IsTheClosedFormOfWhiteNoiseAndADriftInTheChannelsUnit) {
  // sigma(tau)^2 = N^2/tau + R^2 tau^2/2, and a density of N^2; in deg/s a level is 180/pi times that in rad/s.
  constexpr double kN = 2e-4;
  constexpr double kR = 1e-5;
  const Model model{*make_process("white_noise", {kN}), *make_process("linear_drift", {kR})};
  const Unit unit = *parse_unit("deg/s");
  const auto deviation = [&](double tau) { return std::sqrt(kN * kN / tau + 0.5 * kR * kR * tau * tau) / unit.factor; };
  MeasuredDeviation measured;
  for (const double tau : {0.01, 0.08, 5.12}) {
    measured.tau_s.push_back(tau);
    measured.deviation.emplace_back(3.0 * deviation(tau));
    measured.low.emplace_back(2.0 * deviation(tau));
    measured.high.emplace_back(std::nullopt);
  }
  measured.deviation[1].reset();
  const ImpliedBeside beside = implied_beside(model, unit, kDt, measured);

  const MeasuredOverModel& at = beside.at_measured;
  ASSERT_EQ(at.deviation.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(at.deviation[i], deviation(measured.tau_s[i]), 1e-12 * deviation(measured.tau_s[i])) << i;
    EXPECT_EQ(at.ratio[i].has_value(), i != 1) << i;
    EXPECT_NEAR(at.low[i].value_or(0.0), 2.0, 1e-12) << i;
    EXPECT_EQ(at.high[i], std::nullopt) << i;
  }
  EXPECT_NEAR(at.ratio[0].value_or(0.0), 3.0, 1e-12);

  const ImpliedCurves& curves = beside.curves;
  EXPECT_EQ(curves.tau_s.front(), kDt);
  EXPECT_LE(curves.tau_s.back(), 1.25 * 5.12);
  EXPECT_GT(curves.tau_s.back(), 5.12) << "a little beyond what was measured";
  for (std::size_t i = 0; i < curves.tau_s.size(); ++i) {
    EXPECT_NEAR(curves.deviation[i], deviation(curves.tau_s[i]), 1e-12 * deviation(curves.tau_s[i]));
  }
  ASSERT_EQ(curves.f_hz.size(), 160U);
  EXPECT_NEAR(curves.f_hz.front(), 0.5 / 5.12, 1e-12);
  EXPECT_NEAR(curves.f_hz.back(), 0.5 / kDt, 1e-9);
  EXPECT_NEAR(curves.f_hz[1] / curves.f_hz[0], curves.f_hz[159] / curves.f_hz[158], 1e-12);
  ASSERT_EQ(curves.components.size(), 2U);
  const double density = kN * kN / (unit.factor * unit.factor);
  EXPECT_NEAR(curves.components[0].density[50].value_or(0.0), density, 1e-12 * density);
  EXPECT_EQ(curves.components[1].density[50], std::nullopt) << "a drift has no density";
  EXPECT_EQ(curves.density[50], std::nullopt);
  EXPECT_NEAR(curves.components[0].deviation[0], kN / std::sqrt(kDt) / unit.factor, 1e-12);
}

}  // namespace
}  // namespace driftlab
