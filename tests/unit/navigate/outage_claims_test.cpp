#include "core/navigate/outage_claims.hpp"

#include <gtest/gtest.h>

#include <array>

namespace driftlab {
namespace {

constexpr std::array kFilters{"M_stat(AV)",   "M_dyn(AV)",     "M_dyn(GMWM)",
                              "M_stat(GMWM)", "M_stat(AV)+RW", "M_stat(Neq)+RW"};

/// Mean errors by filter, in metres, and half-widths of every paired difference.
OutageEvaluation evaluation_of(const std::array<double, 6>& mean_m, double half_width_m) {
  OutageEvaluation evaluation;
  for (std::size_t f = 0; f < kFilters.size(); ++f) {
    for (std::size_t against = 0; against < kFilters.size(); ++against) {
      PairedDifference pair;
      pair.filter = kFilters[f];
      pair.against = kFilters[against];
      const double gap = mean_m[f] - mean_m[against];
      pair.difference_m = {gap, {gap - half_width_m, gap + half_width_m}};
      const double base = mean_m[against];
      pair.relative = {gap / base, {(gap - half_width_m) / base, (gap + half_width_m) / base}};
      if (f != against) {
        evaluation.paired.push_back(std::move(pair));
      }
    }
  }
  return evaluation;
}

TEST(OutageClaims, TheFiguresOfThePaperSupportItsClaims) {
  // Table 6, all of the gain of GMWM over AV by switching.
  const auto claims = judge_claims(evaluation_of({17.333, 13.107, 10.881, 17.0, 17.2, 17.1}, 0.5));
  ASSERT_EQ(claims.size(), 6U);
  for (const Claim& claim : claims) {
    EXPECT_TRUE(claim.supported) << claim.claim << " " << claim.because;
  }
  EXPECT_EQ(claims[0].because, "M_dyn(AV) against M_stat(AV): -24.4 % [-27.3, -21.5], -4.23 m [-4.73, -3.73].");
  EXPECT_EQ(claims[5].because,
            "Of -6.45 m, low-frequency process noise brings -0.23 m, Gauss-Markov states -0.10 m and switching "
            "-6.12 m [-6.62, -5.62].");
}

TEST(OutageClaims, WhatTheIntervalDoesNotExcludeIsNotSupported) {
  const auto claims = judge_claims(evaluation_of({17.333, 13.107, 10.881, 17.0, 17.2, 17.1}, 7.0));
  EXPECT_FALSE(claims[0].supported) << "the interval holds 0";
  EXPECT_TRUE(claims[1].supported) << "and the size that the paper found";
  EXPECT_FALSE(claims[2].supported);
  EXPECT_FALSE(claims[3].supported);
  EXPECT_FALSE(claims[5].supported);
}

TEST(OutageClaims, SignificantButTinyIsOfNoPracticalSize) {
  const auto claims = judge_claims(evaluation_of({2.0, 1.999, 1.2, 1.2, 1.3, 1.25}, 0.0004));
  EXPECT_FALSE(claims[0].supported);
  EXPECT_EQ(claims[0].because,
            "M_dyn(AV) against M_stat(AV): -0.050 % [-0.070, -0.030], -0.0010 m [-0.0014, -0.0006]. Significant, but "
            "of no practical size: below 1 %.");
  EXPECT_TRUE(claims[3].supported);
  EXPECT_EQ(claims[3].because.find("practical"), std::string::npos);
  // A loss that is significant and tiny is called so too; one that is not significant is not.
  const auto loss = judge_claims(evaluation_of({2.0, 2.001, 1.2, 1.2, 1.3, 1.25}, 0.0004));
  EXPECT_NE(loss[0].because.find("practical size"), std::string::npos) << loss[0].because;
  const auto none = judge_claims(evaluation_of({2.0, 2.001, 1.2, 1.2, 1.3, 1.25}, 0.004));
  EXPECT_EQ(none[0].because.find("practical size"), std::string::npos) << none[0].because;
}

TEST(OutageClaims, AZeroHasNoSign) {
  const auto claims = judge_claims(evaluation_of({2.0, 2.0, 1.2, 1.2, 1.3, 1.25}, 0.0));
  EXPECT_EQ(claims[0].because, "M_dyn(AV) against M_stat(AV): 0.0 % [0.0, 0.0], 0.00 m [0.00, 0.00].");
}

TEST(OutageClaims, ThePartsOfTheGainAddUp) {
  const auto evaluation = evaluation_of({7.4, 7.3, 5.8, 5.9, 6.3, 6.1}, 0.05);
  const auto parts = attribute(evaluation);
  ASSERT_TRUE(parts.has_value());
  EXPECT_NEAR(parts->total.difference_m.value, -1.6, 1e-12);
  EXPECT_NEAR(parts->low_frequency_noise.difference_m.value, -1.3, 1e-12);
  EXPECT_NEAR(parts->gauss_markov_states.difference_m.value, -0.2, 1e-12);
  EXPECT_NEAR(parts->switching.difference_m.value, -0.1, 1e-12);
  EXPECT_NEAR(parts->switching_av.difference_m.value, -0.1, 1e-12);
  EXPECT_FALSE(judge_claims(evaluation)[5].supported) << "a sixteenth of the gain is not where it comes from";
  // Where nothing is gained, nothing is where a gain comes from: switching repairs half of a loss.
  EXPECT_FALSE(judge_claims(evaluation_of({5.0, 5.0, 6.0, 7.0, 7.0, 7.0}, 0.05))[5].supported);
  OutageEvaluation two = evaluation;
  std::erase_if(two.paired, [](const PairedDifference& pair) { return pair.filter == "M_stat(Neq)+RW"; });
  EXPECT_FALSE(attribute(two).has_value());
  EXPECT_TRUE(judge_claims(two).empty());
}

}  // namespace
}  // namespace driftlab
