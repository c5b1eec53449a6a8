#include "core/fit/noise_equivalents.hpp"

#include "core/process/registry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

double value(const std::vector<NoiseEquivalent>& all, const std::string& convention, double si) {
  for (const NoiseEquivalent& one : all) {
    if (one.convention == convention) {
      return one.factor * si;
    }
  }
  return std::nan("");
}

TEST(NoiseEquivalents, DataSheetDensityAndAngleRandomWalkDifferByTheRootOfTwo) {
  // A published gyroscope: 0.05 deg/s/sqrt(Hz), one-sided, and 2.0 deg/sqrt(h): 0.05/sqrt(2) * 60 = 2.12.
  const auto all = white_noise_equivalents(Dimension::AngularRate, 0.01);
  const double si = 0.05 / std::numbers::sqrt2 * std::numbers::pi / 180.0;
  EXPECT_NEAR(value(all, "density_one_sided", si), 0.05, 1e-15);
  EXPECT_NEAR(value(all, "density_two_sided", si), 0.05 / std::numbers::sqrt2, 1e-15);
  EXPECT_NEAR(value(all, "ieee_952", si), 2.1213, 1e-4);
  EXPECT_NEAR(value(all, "kalibr_noise_density", si), si, 1e-18);
  EXPECT_NEAR(value(all, "per_sample", si), 0.05 / std::numbers::sqrt2 * 10.0, 1e-14);
}

TEST(NoiseEquivalents, AccelerometersAreInMicroG) {
  const auto all = white_noise_equivalents(Dimension::SpecificForce, 0.0025);
  EXPECT_NEAR(value(all, "density_two_sided", 9.80665e-4), 100.0, 1e-10);  // 100 ug/sqrt(Hz)
  EXPECT_NEAR(value(all, "ieee_952", 9.80665e-4), 9.80665e-4 * 60.0, 1e-12);
  EXPECT_NEAR(value(all, "per_sample", 9.80665e-4), 0.1 * 20.0, 1e-12);  // mg
}

TEST(NoiseEquivalents, WalkGrowsByTheRootOfTheInterval) {
  const auto all = random_walk_equivalents(Dimension::AngularRate, 0.01);
  EXPECT_NEAR(value(all, "step_per_sample", std::numbers::pi / 180.0), 0.1, 1e-15);
  EXPECT_NEAR(value(all, "kalibr_random_walk", 3e-5), 3e-5, 1e-20);
  EXPECT_NEAR(value(all, "ieee_952", 1.0), 180.0 / std::numbers::pi * 3600.0 * 60.0, 1e-3);
}

FittedProcess fitted(const char* name, std::optional<double> level) {
  FittedProcess process;
  process.kind = find_process(name);
  for (const ParameterSpec& spec : process.kind->parameters) {
    process.parameters.push_back({&spec, std::nullopt, ""});
  }
  if (level) {
    process.parameters.front().estimate = Estimate{*level, {*level / 2.0, *level * 2.0}};
  }
  return process;
}

TEST(LevelEquivalents, AreOfTheWhiteNoiseAndTheRandomWalkOfAFitInTheOrderOfTheModel) {
  ModelFit fit;
  fit.processes = {fitted("white_noise", 2e-4), fitted("gauss_markov", 1e-3), fitted("random_walk", 3e-6)};
  const auto levels = level_equivalents(fit, Dimension::AngularRate, 0.01);
  ASSERT_EQ(levels.size(), 2U);
  EXPECT_EQ(levels[0].parameter, "N");
  EXPECT_EQ(levels[0].level.value, 2e-4);
  EXPECT_EQ(levels[0].level.ci95.high, 4e-4);
  EXPECT_EQ(value(levels[0].conventions, "per_sample", 1.0),
            value(white_noise_equivalents(Dimension::AngularRate, 0.01), "per_sample", 1.0));
  EXPECT_EQ(levels[1].parameter, "K");
  EXPECT_EQ(value(levels[1].conventions, "step_per_sample", 1.0),
            value(random_walk_equivalents(Dimension::AngularRate, 0.01), "step_per_sample", 1.0));
}

TEST(LevelEquivalents, AreSilentOfALevelThatTheDataDoNotIdentify) {
  ModelFit fit;
  fit.processes = {fitted("white_noise", std::nullopt), fitted("gauss_markov", 1e-3)};
  EXPECT_TRUE(level_equivalents(fit, Dimension::SpecificForce, 0.01).empty());
}

}  // namespace
}  // namespace driftlab
