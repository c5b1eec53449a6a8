#include "core/investigate/fullrate/whittle.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab::investigate {
namespace {

/// The mean of `count` standard exponential numbers: an averaged periodogram over its density.
double gamma_mean(Random& random, int count) {
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    sum -= std::log(random.uniform());
  }
  return sum / count;
}

/// A flat level and one that rises with the square of the frequency, on top of a known floor.
LinearDensity two_levels(Random& random, const Eigen::Vector2d& truth) {
  constexpr Eigen::Index kBins = 60;
  LinearDensity density;
  density.power.resize(kBins);
  density.weight.resize(kBins);
  density.fixed = Eigen::VectorXd::Constant(kBins, 0.5);
  density.shape.resize(kBins, 2);
  for (Eigen::Index j = 0; j < kBins; ++j) {
    const double f = static_cast<double>(j + 1) / kBins;
    const int ordinates = 20 + static_cast<int>(j);
    density.shape.row(j) << 1.0, 4.0 * f * f;
    density.weight[j] = ordinates;
    density.power[j] = (0.5 + density.shape.row(j).dot(truth)) * gamma_mean(random, ordinates);
  }
  return density;
}

TEST(Whittle, IsTheSumOfItsDefinition) {
  const Eigen::Vector2d power(2.0, 3.0);
  const Eigen::Vector2d weight(1.0, 4.0);
  const Eigen::Vector2d density(1.0, 2.0);
  EXPECT_DOUBLE_EQ(whittle(power, weight, density), -(1.0 * (0.0 + 2.0)) - 4.0 * (std::log(2.0) + 1.5));
}

TEST(Whittle, OneLevelIsTheWeightedMeanOfPowerOverShape) {
  // d/dL of -sum m [ln(L s) + P/(L s)] is zero at L = sum(m P/s)/sum(m), where the information is sum(m)/L^2. The fit
  // stops once a step gains less than 1e-7, which is within sqrt(2e-7/sum m) of the top, relative to L.
  Random random(5);
  LinearDensity density;
  density.power.resize(40);
  density.weight.resize(40);
  density.fixed = Eigen::VectorXd::Zero(40);
  density.shape.resize(40, 1);
  double mean = 0.0;
  double weights = 0.0;
  for (Eigen::Index j = 0; j < 40; ++j) {
    density.weight[j] = 10.0 + static_cast<double>(j);
    density.shape(j, 0) = 1.0 + 0.1 * static_cast<double>(j);
    density.power[j] = 3.0 * density.shape(j, 0) * gamma_mean(random, 10 + static_cast<int>(j));
    mean += density.weight[j] * density.power[j] / density.shape(j, 0);
    weights += density.weight[j];
  }
  mean /= weights;
  const LevelFit fit = fit_levels(density, Eigen::VectorXd::Constant(1, 0.2));
  EXPECT_NEAR(fit.level[0], mean, 2.0 * mean * std::sqrt(2e-7 / weights));
  EXPECT_NEAR(fit.covariance(0, 0), mean * mean / weights, 1e-3 * mean * mean / weights);
  EXPECT_NEAR(fit.log_likelihood, whittle(density.power, density.weight, mean * density.shape.col(0)), 1e-6);
}

TEST(Whittle, LevelsScatterAboutTheTruthAsTheirCovarianceSays) {
  // 400 fits: the standardised errors have mean 0 +- 4/sqrt(400), allowing the bias of order 1/sum(m) sd, and variance
  // 1 +- 4 sqrt(2/400).
  const Eigen::Vector2d truth(2.0, 1.5);
  constexpr int kFits = 400;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d square = Eigen::Vector2d::Zero();
  double cross = 0.0;
  double expected_cross = 0.0;
  for (int i = 0; i < kFits; ++i) {
    Random random(11, static_cast<std::uint64_t>(i));
    const LevelFit fit = fit_levels(two_levels(random, truth), Eigen::Vector2d(1.0, 1.0));
    const Eigen::Vector2d sd = fit.covariance.diagonal().cwiseSqrt();
    const Eigen::Vector2d z = (fit.level - truth).cwiseQuotient(sd);
    mean += z / kFits;
    square += z.cwiseAbs2() / kFits;
    cross += z[0] * z[1] / kFits;
    expected_cross += fit.covariance(0, 1) / sd.prod() / kFits;
  }
  for (const int k : {0, 1}) {
    EXPECT_NEAR(mean[k], 0.0, 4.0 / std::sqrt(kFits) + 0.05);
    EXPECT_NEAR(square[k], 1.0, 4.0 * std::sqrt(2.0 / kFits));
  }
  EXPECT_LT(expected_cross, -0.3) << "the two levels share the power between them";
  EXPECT_NEAR(cross, expected_cross, 4.0 * std::sqrt(2.0 / kFits));
}

TEST(Whittle, TheFitIsTheTopOfTheLikelihoodFromAnyStart) {
  Random random(17);
  const LinearDensity density = two_levels(random, {2.0, 1.5});
  const LevelFit fit = fit_levels(density, Eigen::Vector2d(1.0, 1.0));
  const auto at = [&](const Eigen::Vector2d& level) -> double {
    return whittle(density.power, density.weight, density.fixed + density.shape * level);
  };
  EXPECT_NEAR(fit.log_likelihood, at(fit.level), 1e-9);
  for (const Eigen::Vector2d& step :
       {Eigen::Vector2d(1e-2, 0.0), Eigen::Vector2d(-1e-2, 0.0), Eigen::Vector2d(0.0, 1e-2),
        Eigen::Vector2d(0.0, -1e-2), Eigen::Vector2d(1e-2, -1e-2)}) {
    EXPECT_LT(at(fit.level + step), fit.log_likelihood);
  }
  const LevelFit far = fit_levels(density, Eigen::Vector2d(50.0, 0.0));
  EXPECT_NEAR(far.log_likelihood, fit.log_likelihood, 1e-6);
}

TEST(Whittle, ALevelThatTheDataLackIsZero) {
  Random random(19);
  LinearDensity density = two_levels(random, {2.0, 0.0});
  density.power.array() -= 0.6 * density.shape.col(1).array();  // less at the top of the band than any level explains
  const LevelFit fit = fit_levels(density, Eigen::Vector2d(1.0, 1.0));
  EXPECT_EQ(fit.level[1], 0.0);
  density.shape = density.shape.leftCols(1).eval();
  const LevelFit alone = fit_levels(density, Eigen::VectorXd::Ones(1));
  // Both stop within 1e-7 of the same top: sqrt(2e-7) of a standard deviation, which is about 0.03.
  EXPECT_NEAR(fit.level[0], alone.level[0], 1e-4) << "the other level is what it is without the one that is zero";
}

}  // namespace
}  // namespace driftlab::investigate
