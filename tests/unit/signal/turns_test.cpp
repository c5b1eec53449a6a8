#include "core/signal/turns.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

/// A table that turns at `rate` [rad/s], as an encoder of one turn reads it.
std::vector<double> encoder(double rate, std::size_t samples) {
  std::vector<double> angles(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    angles[i] = std::fmod(rate * kDt * static_cast<double>(i), kTurn);
  }
  return angles;
}

TEST(RateOfAngle, OfAnEncoderThatStartsAgainIsTheRateOfTheTable) {
  for (const double rate : {1.0, -1.0, 100.0, 0.49 * kTurn / kDt}) {
    // Each of two angles is rounded as rate times 20 s is, twice; at the ends their difference is divided by dt.
    const double rounding = 4.0 * std::ldexp(1.0, -53) * (20.0 * std::fabs(rate) + kTurn) / kDt;
    for (const double found : rate_of_angle(encoder(rate, 2000), kDt)) {
      ASSERT_NEAR(found, rate, rounding) << rate;
    }
  }
}

TEST(RateOfAngle, OfAnglesThatNeverStartAgainIsTheirSlopeToTheBit) {
  std::vector<double> angles(500);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    angles[i] = 30.0 * std::sin(0.37 * static_cast<double>(i) * kDt) + 0.1;
  }
  EXPECT_EQ(rate_of_angle(angles, kDt), slope(angles, kDt));
}

TEST(Slope, OfFewValues) {
  EXPECT_TRUE(slope({}, kDt).empty());
  EXPECT_TRUE(rate_of_angle({}, kDt).empty());
  EXPECT_THAT(slope(std::vector{3.0}, kDt), testing::ElementsAre(0.0));
  EXPECT_THAT(rate_of_angle(std::vector{3.0}, kDt), testing::ElementsAre(0.0));
  EXPECT_THAT(slope(std::vector{3.0, 5.0}, 0.5), testing::ElementsAre(4.0, 4.0));
}

TEST(ContinuousAngle, GoesOnAtItsPaceOverPlacesWithoutASample) {
  // 300 places are missing, in which the table turns three times and a bit.
  const double rate = 7.0;
  std::vector<double> angles;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < 1000; ++i) {
    if (i < 400 || i >= 700) {
      angles.push_back(std::fmod(rate * kDt * static_cast<double>(i), kTurn));
      places.push_back(i);
    }
  }
  const std::vector<double> whole = continuous_angle(angles, places);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    ASSERT_NEAR(whole[i], rate * kDt * static_cast<double>(places[i]), 1e-12) << i;
  }
}

TEST(ContinuousAngle, LeavesAnglesThatCountTheirTurnsAloneWhateverTheyDoInAGap) {
  const std::vector<double> angles{0.0, 0.1, 0.2, 50.0, 50.1};
  EXPECT_EQ(continuous_angle(angles, std::vector<std::size_t>{0, 1, 2, 40, 41}), angles);
}

TEST(ContinuousAngle, PassesOverWhatIsNoNumber) {
  std::vector<double> angles = encoder(20.0, 100);
  angles[30] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> whole = continuous_angle(angles, {});
  EXPECT_TRUE(std::isnan(whole[30]));
  EXPECT_NEAR(whole[99], 20.0 * kDt * 99.0, 1e-12);
}

}  // namespace
}  // namespace driftlab
