#include "core/fit/discrepancy.hpp"

#include "core/fit/curve_covariance.hpp"
#include "core/process/dense.hpp"
#include "core/process/distributions.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

/// A covariance whose standard deviations rise from 0.2 % to 80 %, neighbours correlated by a half.
Eigen::MatrixXd covariance_of(Eigen::Index rows) {
  Eigen::MatrixXd covariance(rows, rows);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < rows; ++j) {
      const double sd = 0.002 * 0.002 * std::exp2(0.5 * static_cast<double>(i + j));
      covariance(i, j) = sd * std::pow(0.5, std::fabs(static_cast<double>(i - j)));
    }
  }
  return covariance;
}

TEST(Discrepancy, WhiteningInvertsCovarianceAndDiscrepancyTogether) {
  const Eigen::MatrixXd covariance = covariance_of(12);
  for (const double delta : {0.0, 0.01, 1.0}) {
    const Eigen::MatrixXd whitening = discrepancy_whitening(covariance, delta);
    const Eigen::MatrixXd sum = covariance + delta * delta * Eigen::MatrixXd::Identity(12, 12);
    EXPECT_LT((whitening * sum * whitening.transpose() - Eigen::MatrixXd::Identity(12, 12)).norm(), 1e-11) << delta;
  }
}

TEST(Discrepancy, IsWhereTheDistanceEqualsItsDegreesOfFreedom) {
  const Eigen::MatrixXd covariance = covariance_of(12);
  const Eigen::VectorXd residual = Eigen::VectorXd::LinSpaced(12, -0.1, 0.1);
  const double delta = discrepancy_of(residual, covariance, 9.0);
  EXPECT_GT(delta, 0.01);
  EXPECT_LT(delta, 0.1);
  // delta is found to 1 %, and L changes by at most twice the share by which delta does
  EXPECT_NEAR((discrepancy_whitening(covariance, delta) * residual).squaredNorm(), 9.0, 0.02 * 9.0);
  EXPECT_EQ(discrepancy_of(1e-4 * residual, covariance, 9.0), 0.0) << "a residual within its scatter needs none";
}

TEST(Discrepancy, FindsTheRootOfAFallingDistanceFromAnyGuess) {
  for (const double first : {1e-6, 0.02, 30.0}) {
    const double delta = find_discrepancy([](double d) { return 1.0 / (1e-8 + d * d); }, 2500.0, first);
    EXPECT_NEAR(delta, 0.02, 0.0003) << first;
  }
  EXPECT_EQ(find_discrepancy([](double d) { return 1.0 / (1.0 + d * d); }, 2.0, 1.0), 0.0);
}

TEST(Discrepancy, SandwichIsTheCurvatureWhereTheWeightsAreRightAndLargerElsewhere) {
  const Eigen::MatrixXd covariance = covariance_of(10);
  Eigen::MatrixXd jacobian(10, 2);
  jacobian.col(0).setOnes();
  jacobian.col(1).setLinSpaced(-1.0, 1.0);
  const Eigen::MatrixXd right = covariance + 0.0004 * Eigen::MatrixXd::Identity(10, 10);
  const auto sandwich = [&](double delta, const Eigen::MatrixXd& scatter) -> Eigen::MatrixXd {
    const Eigen::MatrixXd whitening = discrepancy_whitening(covariance, delta);
    const Eigen::MatrixXd whitened = whitening * scatter * whitening.transpose();
    const Eigen::MatrixXd slope = whitening * jacobian;
    return sandwich_covariance(slope, BlockDiagonal(whitened));
  };
  const Eigen::MatrixXd best = sandwich(0.02, right);
  const Eigen::MatrixXd information = jacobian.transpose() * inverse(right) * jacobian;
  EXPECT_LT((best * information - Eigen::MatrixXd::Identity(2, 2)).norm(), 1e-9);
  const Eigen::MatrixXd other = sandwich(0.0, right);
  EXPECT_GT(other(0, 0), best(0, 0));
  EXPECT_GT(other(1, 1), best(1, 1));
  jacobian.col(1).setZero();  // a coordinate that moves nothing
  EXPECT_GE(sandwich(0.0, covariance)(1, 1), 0.99e14);
}

TEST(CurveCovariance, IsThatOfLogarithmsOfChiSquares) {
  Eigen::VectorXd nu(3);
  nu << 1.0, 0.0, 2.0;
  Eigen::MatrixXd covariance(3, 3);
  covariance << 0.2, 0.0, 0.4, 0.0, 1.0, 0.0, 0.4, 0.0, 0.8;  // 10 degrees of freedom each, correlation 1
  const CurveCovariance curve = curve_covariance(nu, nu + Eigen::VectorXd::Constant(3, 1e-300), covariance);
  ASSERT_EQ(curve.used, (std::vector<Eigen::Index>{0, 2})) << "a variance of zero has no logarithm";
  EXPECT_NEAR(curve.edf(0), 10.0, 1e-12);
  EXPECT_NEAR(curve.covariance.whole()(0, 0), trigamma(5.0), 1e-12);
  // Logarithms of the same chi-square: all terms of the series make psi', 48 of them all but 1/(48^5) or so.
  EXPECT_NEAR(curve.covariance.whole()(0, 1), trigamma(5.0), 1e-5);
  EXPECT_NEAR(curve.log_variance(1), std::log(2.0) - (digamma(5.0) - std::log(5.0)), 1e-12);
}

}  // namespace
}  // namespace driftlab
