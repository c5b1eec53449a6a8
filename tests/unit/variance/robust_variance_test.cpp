#include "core/variance/robust_variance.hpp"

#include "core/variance/contamination.hpp"
#include "core/variance/samples.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

std::vector<double> white(std::size_t n, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> x(n);
  for (double& value : x) {
    value = random.normal();
  }
  return x;
}

struct Analysis {
  HaarVariance curve;
  VarianceIntervals classical;
  RobustVariance robust;
  ContaminationTest test;
};

Analysis analyse(const std::vector<double>& x) {
  const double pivot = summarise(x)->mean;
  Analysis a;
  a.curve = haar_variance(x, pivot);
  HaarCovariance plan(a.curve.half, x.size(), 1.0);
  a.classical = variance_intervals(a.curve, plan);
  a.robust = robust_variance(x, pivot, a.curve, a.classical, plan);
  a.test = test_contamination(x, 1.0, a.curve, a.classical, a.robust, plan);
  return a;
}

TEST(Biweight, ExpansionOfTheUnboundedSquareIsItsOwnSecondTerm) {
  // c -> infinity: chi -> r^2 = 1 + sqrt(2) h_2. At c = 12 the bound still shows as 3 * 4/c^2 or so of relative size.
  const Biweight wide = Biweight::with(60.0);
  EXPECT_NEAR(wide.mean, 1.0, 0.005);
  EXPECT_NEAR(wide.hermite[0], std::sqrt(2.0), 0.02);
  EXPECT_NEAR(wide.hermite[1], 0.0, 0.02);
}

TEST(Biweight, TuningForIndependentDataAndForWhiteOverlap) {
  // Independent data: S_k = const. The published constant for 0.6 is 4.40 (estimator's definition); with the overlap of
  // white noise at long scales 3.69.
  std::array<double, HaarCovariance::kEvenPowers> independent{};
  independent.fill(1.0);
  EXPECT_NEAR(tune_biweight(independent).c, 4.40, 0.02);
  const std::vector<std::size_t> half{1, 2, 4, 8, 16, 32, 64, 128};
  HaarCovariance plan(half, 1 << 16, 1.0);
  const Model model{*make_process("white_noise", {1.0})};
  EXPECT_NEAR(tune_biweight(plan.correlation_sums(0, 0, model)).c, 4.14, 0.03);
  EXPECT_NEAR(tune_biweight(plan.correlation_sums(7, 7, model)).c, 3.69, 0.03);
}

TEST(RobustVariance, CleanGaussianNoiseKeepsItsVariance) {
  const auto x = white(1 << 16, 5);
  const Analysis a = analyse(x);
  for (std::size_t j = 0; j < 8; ++j) {
    // Standard error sqrt(2/(edf eff)); four of them.
    const double expected = 1.0 / static_cast<double>(2 * a.curve.half[j]);
    ASSERT_TRUE(a.robust.variance[j].has_value());
    EXPECT_NEAR(*a.robust.variance[j], expected, 4.0 * expected * std::sqrt(2.0 / a.robust.edf[j]));
  }
  EXPECT_NE(a.test.verdict, ContaminationVerdict::Contaminated);
}

TEST(RobustVariance, GrossErrorsLeaveTheShortScalesAndAreNamed) {
  auto x = white(1 << 15, 6);
  Random random(7);
  for (double& value : x) {
    if (random.uniform() < 0.001) {
      value += 1000.0 * random.normal();
    }
  }
  const Analysis a = analyse(x);
  EXPECT_GT(a.curve.variance[0], 100.0);
  EXPECT_NEAR(*a.robust.variance[0], 0.5, 0.03);
  EXPECT_EQ(a.test.verdict, ContaminationVerdict::Contaminated);
  EXPECT_LT(a.test.p, 0.01);
  EXPECT_FALSE(a.test.disjoint_scales.empty());
}

TEST(RobustVariance, UniformQuantizationErrorsAreAnotherShapeAndNoContamination) {
  Random random(8);
  const Model model{*make_process("quantization_noise", {1.0})};
  const auto x = simulate(model, random, 1.0, 1 << 14);
  const Analysis a = analyse(x);
  EXPECT_EQ(a.test.verdict, ContaminationVerdict::Undecided);
  EXPECT_TRUE(a.test.not_gaussian);
}

TEST(RobustVariance, ConstantAlternationAndImpulseAreFlaggedNotBroken) {
  std::vector<double> x(1024, 0.0);
  x[500] = 1.0;
  Analysis a = analyse(x);
  EXPECT_FALSE(a.robust.variance[0].has_value()) << "all coefficients but two are zero: there is no scale to find";
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = i % 2 == 0 ? 1.0 : -1.0;
  }
  a = analyse(x);
  for (const auto& value : a.robust.variance) {
    EXPECT_TRUE(!value || std::isfinite(*value));
  }
}

}  // namespace
}  // namespace driftlab
