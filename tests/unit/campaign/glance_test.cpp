#include "core/campaign/glance.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace driftlab {
namespace {

ReportedValue told(double value, const char* unit) { return {value, std::nullopt, std::nullopt, unit, ""}; }

ReportedValue density(double value) { return told(value, "deg/sqrt(h)"); }

ReportedFit fit(std::optional<double> p) {
  ReportedFit best;
  best.model = "WN+GM";
  best.processes = {{"white_noise", {{"N", density(0.2)}}}, {"gauss_markov", {{"sigma", told(5.0, "deg/h")}}}};
  if (p) {
    best.j_test = JTest{.statistic = 1.0, .dof = 8.0, .p = *p};
  }
  return best;
}

TEST(AxisGlance, IsFineWhereTheJTestAcceptsTheModelAndElseSaysWhyNot) {
  const AxisGlance fine = glance_of(fit(kRejected), density(0.3));
  EXPECT_EQ(fine.fits, true);
  EXPECT_EQ(fine.level, VerdictLevel::Fine);
  EXPECT_TRUE(fine.reason.empty());
  const AxisGlance rejected = glance_of(fit(0.5 * kRejected), density(0.3));
  EXPECT_EQ(rejected.fits, false);
  EXPECT_EQ(rejected.level, VerdictLevel::Look);
  EXPECT_EQ(rejected.reason, "the best model does not fit (J test p < 0.01)");
  for (const std::optional<double> p :
       {std::optional<double>(), std::optional(std::numeric_limits<double>::quiet_NaN())}) {
    const AxisGlance untested = glance_of(fit(p), density(0.3));
    EXPECT_EQ(untested.fits, std::nullopt);
    EXPECT_EQ(untested.level, VerdictLevel::Look);
    EXPECT_EQ(untested.reason, "too few scales to test whether the best model fits");
  }
}

TEST(AxisGlance, HasTheDensityThatWasKeptAndOfOlderResultsTheModelsWhiteNoise) {
  EXPECT_EQ(glance_of(fit(0.5), density(0.3)).density, density(0.3));
  EXPECT_EQ(glance_of(fit(0.5), std::nullopt).density, density(0.2));
  EXPECT_EQ(glance_of(fit(0.5), ReportedValue{}).density.value, std::nullopt) << "kept, and there is none";
  ReportedFit walk = fit(0.5);
  walk.processes.erase(walk.processes.begin());
  EXPECT_EQ(glance_of(walk, std::nullopt).density.value, std::nullopt);
}

}  // namespace
}  // namespace driftlab
