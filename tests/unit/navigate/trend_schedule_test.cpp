#include "core/navigate/trend_schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

Model base() { return {*make_process("white_noise", {1.0}), *make_process("gauss_markov", {0.5, 0.1})}; }

/// value(w) = low + (high - low) (w/last)^exponent of one parameter.
ParameterTrend trend(std::size_t process, std::size_t parameter, double low, double high, double exponent,
                     double last) {
  return {process, parameter, [=](double rate) { return low + (high - low) * std::pow(rate / last, exponent); }, last};
}

TEST(TrendSchedule, FollowsEachRelationWithinHalfAStep) {
  // N = 1 + 2 (w/2)^0.5, sigma falls from 0.5 to 0.1 over 1 rad/s and stays, beta is constant.
  const ModelSchedule schedule =
      *schedule_along(base(), {trend(0, 0, 1.0, 3.0, 0.5, 2.0), trend(1, 0, 0.5, 0.1, 1.0, 1.0)}, 0.01);
  EXPECT_EQ(schedule.size(), 201U);
  for (const double rate : {0.1, 0.5, 1.2, 1.99}) {
    const Model& model = schedule.model(schedule.band(-rate));
    const double slope = 0.5 * 2.0 * std::pow(rate / 2.0, -0.5) / 2.0;
    EXPECT_NEAR(model[0].parameters[0], 1.0 + 2.0 * std::sqrt(rate / 2.0), 0.0051 * slope + 1e-4);
    EXPECT_NEAR(model[1].parameters[0], 0.5 - 0.4 * std::min(rate, 1.0), 0.0021);
    EXPECT_NEAR(model[1].parameters[1], 0.1, 1e-15);
  }
  EXPECT_NEAR(schedule.model(schedule.band(50.0))[0].parameters[0], 3.0, 1e-12);
}

TEST(TrendSchedule, WithoutTrendsItIsTheModel) {
  const ModelSchedule schedule = *schedule_along(base(), {}, 0.01);
  EXPECT_EQ(schedule.size(), 1U);
  EXPECT_EQ(schedule.model(0)[0].parameters[0], 1.0);
}

TEST(TrendSchedule, RefusesParametersThatTheModelLacks) {
  EXPECT_FALSE(schedule_along(base(), {trend(2, 0, 1.0, 2.0, 1.0, 1.0)}, 0.01));
  EXPECT_FALSE(schedule_along(base(), {trend(0, 1, 1.0, 2.0, 1.0, 1.0)}, 0.01));
  EXPECT_FALSE(schedule_along(base(), {trend(0, 0, 1.0, 2.0, 1.0, 1.0)}, 0.0));
  EXPECT_FALSE(schedule_along(base(), {trend(0, 0, 1.0, 2.0, 1.0, 100.0)}, 0.01));
}

}  // namespace
}  // namespace driftlab
