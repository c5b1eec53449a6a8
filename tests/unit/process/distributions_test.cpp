/// Tails and quantiles against printed tables (Abramowitz and Stegun 26, 6.3, 6.4), and each other's inverse.
#include "core/process/distributions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

namespace driftlab {
namespace {

TEST(Distributions, EqualTheTables) {
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_NEAR(normal_density(0.0), 0.3989422804014327, 1e-15);
  EXPECT_NEAR(normal_tail(6.0), 9.865876450376981e-10, 1e-20);
  EXPECT_NEAR(chi_squared_quantile(0.95, 1.0), 3.841458820694124, 1e-12);
  EXPECT_NEAR(chi_squared_quantile(0.025, 10.0), 3.246972780236840, 1e-12);
  for (const auto& [dof, quantile] : {std::pair{1.0, 12.7062}, std::pair{5.0, 2.57058}, std::pair{10.0, 2.22814},
                                      std::pair{30.0, 2.04227}, std::pair{399.0, 1.96593}}) {
    EXPECT_NEAR(student_quantile(0.975, dof), quantile, 1e-4) << dof;
  }
  EXPECT_NEAR(digamma(1.0), -0.5772156649015329, 1e-15);
  EXPECT_NEAR(trigamma(1.0), 1.6449340668482264, 1e-15);
  EXPECT_NEAR(log_gamma(0.5), 0.5723649429247001, 1e-15);
}

TEST(Distributions, TailsUndoQuantiles) {
  for (const double p : {0.001, 0.025, 0.5, 0.975, 0.999}) {
    EXPECT_NEAR(normal_tail(normal_quantile(p)), 1.0 - p, 1e-13) << p;
    for (const double dof : {0.5, 3.0, 47.5, 1e6}) {
      EXPECT_NEAR(chi_squared_tail(chi_squared_quantile(p, dof), dof), 1.0 - p, 1e-10) << p << " " << dof;
      EXPECT_NEAR(student_tail(student_quantile(p, dof), dof), 1.0 - p, 1e-10) << p << " " << dof;
    }
  }
}

TEST(Distributions, FarTailsAndBadArgumentsDoNotThrow) {
  EXPECT_EQ(chi_squared_tail(-1e-9, 3.0), 1.0);
  EXPECT_EQ(chi_squared_tail(1e9, 3.0), 0.0);
  EXPECT_GT(chi_squared_tail(1000.0, 3.0), 0.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(normal_quantile(nan)));
  EXPECT_TRUE(std::isnan(chi_squared_tail(nan, 3.0)));
  EXPECT_TRUE(std::isnan(chi_squared_quantile(0.5, -1.0)));
}

}  // namespace
}  // namespace driftlab
