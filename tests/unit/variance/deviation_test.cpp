// Variances as deviations: the roots of the estimates and of the ends of their intervals.
#include "core/variance/deviation.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

struct Variances {
  std::vector<double> tau_s;
  std::vector<double> variance;
  std::vector<Interval> ci95;
  std::vector<double> edf;
};

TEST(DeviationCurve, HasTheRootOfEachVarianceAndOfTheEndsOfItsInterval) {
  const Variances curve{{0.1, 0.2}, {4.0, 0.25}, {{1.0, 9.0}, {-0.01, 1.0}}, {30.0, 2.0}};
  const DeviationCurve told = deviations_of(curve);
  EXPECT_EQ(told.tau_s, curve.tau_s);
  EXPECT_EQ(told.deviation, (std::vector<double>{2.0, 0.5}));
  EXPECT_EQ(told.ci95[0].low, 1.0);
  EXPECT_EQ(told.ci95[0].high, 3.0);
  EXPECT_EQ(told.ci95[1].low, 0.0) << "an interval of a variance may reach below 0";
  EXPECT_EQ(told.ci95[1].high, 1.0);
  EXPECT_EQ(told.edf, curve.edf);
}

TEST(DeviationCurve, OfASurfaceKeepsItsRows) {
  EXPECT_EQ(deviations_of(std::vector<std::vector<double>>{{4.0, 9.0}, {16.0}}),
            (std::vector<std::vector<double>>{{2.0, 3.0}, {4.0}}));
  EXPECT_TRUE(std::isnan(deviation_of(-1.0)));
}

}  // namespace
}  // namespace driftlab
