#include "core/navigate/look_ahead.hpp"

#include "core/signal/angle.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

RecordedPose moving(const Vector3& velocity_ned_m_s) {
  RecordedPose pose;
  pose.velocity_ned_m_s = velocity_ned_m_s;
  pose.attitude = {0.1, 0.2, 0.3};
  return pose;
}

/// At rest, north-east and up at 5 %, crawling south, then east.
std::vector<RecordedPose> drive() {
  return {moving({0.0, 0.0, 0.0}), moving({3.0, 3.0, -0.05 * std::hypot(3.0, 3.0)}), moving({-0.3, 0.0, 0.3}),
          moving({0.0, 2.0, 0.0})};
}

TEST(LookAhead, AVehicleLooksWhereItGoesAndKeepsThatWhileItIsSlow) {
  std::vector<RecordedPose> poses = drive();
  look_ahead(poses, {.pitch = true, .heading = true});
  const double up = std::atan(0.05);
  const std::vector<std::pair<double, double>> expected{
      {45.0 * kDegree, 0.0}, {45.0 * kDegree, up}, {45.0 * kDegree, up}, {90.0 * kDegree, 0.0}};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(poses[i].attitude.heading_rad, expected[i].first, 1e-15) << i;
    EXPECT_NEAR(poses[i].attitude.pitch_rad, expected[i].second, 1e-15) << i;
    EXPECT_EQ(poses[i].attitude.roll_rad, 0.1) << i;
  }
}

TEST(LookAhead, AnAngleThatIsKnownStays) {
  std::vector<RecordedPose> poses = drive();
  look_ahead(poses, {.pitch = false, .heading = true});
  EXPECT_EQ(poses[1].attitude.pitch_rad, 0.2);
  EXPECT_NE(poses[1].attitude.heading_rad, 0.3);
  poses = drive();
  look_ahead(poses, {.pitch = true, .heading = false});
  EXPECT_NE(poses[1].attitude.pitch_rad, 0.2);
  EXPECT_EQ(poses[1].attitude.heading_rad, 0.3);
}

TEST(LookAhead, AVehicleThatHardlyMovesHasNoDirection) {
  std::vector<RecordedPose> poses{moving({0.4, 0.0, 0.0}), moving({0.0, -0.4, 0.2})};
  look_ahead(poses, {.pitch = true, .heading = true});
  for (const RecordedPose& pose : poses) {
    EXPECT_EQ(pose.attitude.heading_rad, 0.0);
    EXPECT_EQ(pose.attitude.pitch_rad, 0.0);
  }
  std::vector<RecordedPose> none;
  look_ahead(none, {.pitch = true, .heading = true});
  EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace driftlab
