// The mechanisation against motions whose outcome is known in closed form.
#include "core/navigate/strapdown.hpp"

#include "core/navigate/paper_scenario.hpp"
#include "core/navigate/recorded_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Vector3 rate_of(const ImuSample& sample) { return {sample[0], sample[1], sample[2]}; }
Vector3 force_of(const ImuSample& sample) { return {sample[3], sample[4], sample[5]}; }

TEST(Strapdown, StaysWhereItRests) {
  // Ten minutes at rest, tilted: force -g, rate w_ie in body axes. Rounding alone is left: 6e4 steps of an attitude
  // known to 1e-16 tilt gravity by at most sqrt(6e4) 1e-16 x 9.8 = 2e-13 m/s^2, or t^2/2 of that, 4e-8 m.
  NavigationState start;
  start.position_ecef_m = to_ecef({0.8, 0.3, 200.0});
  start.attitude = Quaternion(ned_axes(0.8, 0.3)) * from_euler({0.2, -0.3, 1.0});
  const Vector3 force = -(start.attitude.conjugate() * normal_gravity(start.position_ecef_m));
  const Vector3 rate = start.attitude.conjugate() * earth_rate();
  Strapdown strapdown(start, 0.01);
  for (int i = 0; i < 60000; ++i) {
    (void)strapdown.advance(rate, force);
  }
  EXPECT_LT((strapdown.state().position_ecef_m - start.position_ecef_m).norm(), 1e-5);
  EXPECT_LT((strapdown.state().velocity_ecef_m_s).norm(), 1e-7);
  EXPECT_LT(rotation_vector(strapdown.state().attitude * start.attitude.conjugate()).norm(), 1e-11);
}

TEST(Strapdown, FollowsAConstantTurn) {
  // At the equator a level circle of radius v/w about a centre moving with the Earth, in 100 s of 18 deg/s: back at its
  // start after five turns. Forces are those of the motion in the plane, gravity and Coriolis by hand.
  const double v = 15.0;
  const double w = 18.0 * kDegree;
  const Geodetic centre{0.0, 0.0, 0.0};
  const Vector3 origin = to_ecef(centre);
  const Matrix3 axes = ned_axes(0.0, 0.0);
  const double dt = 0.01;
  // Plane circle: position origin + axes (v/w)(sin wt, 1 - cos wt, 0); the body turns with it about the plane's normal.
  const auto force_at = [&](double t) -> Vector3 {
    const Vector3 r = origin + axes * (v / w * Vector3(std::sin(w * t), 1.0 - std::cos(w * t), 0.0));
    const Vector3 u = axes * (v * Vector3(std::cos(w * t), std::sin(w * t), 0.0));
    const Vector3 a = axes * (v * w * Vector3(-std::sin(w * t), std::cos(w * t), 0.0));
    const Quaternion attitude = Quaternion(axes) * from_euler({0.0, 0.0, w * t});
    return attitude.conjugate() * (a + 2.0 * earth_rate().cross(u) - normal_gravity(r));
  };
  const auto rate_at = [&](double t) -> Vector3 {
    const Quaternion attitude = Quaternion(axes) * from_euler({0.0, 0.0, w * t});
    return Vector3(0.0, 0.0, w) + attitude.conjugate() * earth_rate();
  };
  NavigationState start;
  start.position_ecef_m = origin;
  start.velocity_ecef_m_s = axes * Vector3(v, 0.0, 0.0);
  start.attitude = Quaternion(axes);
  Strapdown strapdown(start, dt);
  for (int i = 0; i < 10000; ++i) {
    const double t = i * dt;
    // Simpson's rule for the means over the sample.
    const Vector3 rate = (rate_at(t) + 4.0 * rate_at(t + 0.5 * dt) + rate_at(t + dt)) / 6.0;
    const Vector3 force = (force_at(t) + 4.0 * force_at(t + 0.5 * dt) + force_at(t + dt)) / 6.0;
    (void)strapdown.advance(rate, force);
  }
  EXPECT_LT((strapdown.state().position_ecef_m - origin).norm(), 2e-4);
  EXPECT_LT((strapdown.state().velocity_ecef_m_s - start.velocity_ecef_m_s).norm(), 2e-5);
  EXPECT_LT(rotation_vector(strapdown.state().attitude * start.attitude.conjugate()).norm(), 1e-8);
}

TEST(Strapdown, ConingIsCorrected) {
  // Classical coning: the body's z axis draws a cone of half angle a at frequency f; rates in body axes are
  // (w sin a cos wt, w sin a sin wt, w (1 - cos a))-like, and uncorrected the attitude drifts by (w sin a)^2 dt^2 w/12
  // a second. With the two-sample correction what is left is of order (w dt)^4 of the coning rate: 1e-4 of it here.
  const double a = 1.0 * kDegree;
  const double w = 2.0 * std::numbers::pi * 5.0;
  const double dt = 0.01;
  NavigationState start;
  start.position_ecef_m = to_ecef({0.5, 0.0, 0.0});
  const auto attitude_at = [&](double t) {  // relative to inertial space at time 0
    return Quaternion(std::cos(0.5 * a), std::sin(0.5 * a) * std::cos(w * t), std::sin(0.5 * a) * std::sin(w * t), 0.0);
  };
  start.attitude = attitude_at(0.0);
  Strapdown strapdown(start, dt);
  const double seconds = 10.0;
  for (int i = 0; i < static_cast<int>(seconds / dt); ++i) {
    // q' = q (0, rate)/2 gives rate = (-w sin a sin wt, w sin a cos wt, -w (1 - cos a)); its integral over a sample:
    const double t0 = i * dt;
    const double t1 = t0 + dt;
    const Vector3 angle(std::sin(a) * (std::cos(w * t1) - std::cos(w * t0)),
                        std::sin(a) * (std::sin(w * t1) - std::sin(w * t0)), -w * (1.0 - std::cos(a)) * dt);
    (void)strapdown.advance(angle / dt, Vector3::Zero());
  }
  // Inertial to e: the Earth turned meanwhile.
  const Quaternion expected = rotation(-seconds * earth_rate()) * attitude_at(seconds);
  const double coning_rad = 0.5 * w * a * a * seconds;  // area swept: what ignoring the cone altogether would cost
  const double uncorrected = coning_rad * (w * dt) * (w * dt) / 6.0;
  const double error = rotation_vector(strapdown.state().attitude * expected.conjugate()).norm();
  EXPECT_LT(error, 0.03 * uncorrected);
  EXPECT_GT(uncorrected, 1e-4);  // the test would notice a missing correction
}

TEST(Strapdown, FollowsAGreatCircleAroundARotatingEarth) {
  // A circle of radius R about the Earth's centre in a plane tilted by 50 deg in e, at 200 m/s: r = R (p cos ut + q sin
  // ut).
  const double radius = 6378137.0 + 9000.0;
  const double u = 200.0 / radius;
  const Vector3 p(1.0, 0.0, 0.0);
  const Vector3 q(0.0, std::cos(50.0 * kDegree), std::sin(50.0 * kDegree));
  const Vector3 normal = p.cross(q);
  const auto position = [&](double t) -> Vector3 { return radius * (p * std::cos(u * t) + q * std::sin(u * t)); };
  const auto velocity = [&](double t) -> Vector3 { return radius * u * (q * std::cos(u * t) - p * std::sin(u * t)); };
  const auto attitude = [&](double t) { return rotation(u * t * normal); };  // the body turns with the radius vector
  const auto force = [&](double t) -> Vector3 {
    const Vector3 acceleration = -u * u * position(t);
    return attitude(t).conjugate() *
           (acceleration + 2.0 * earth_rate().cross(velocity(t)) - normal_gravity(position(t)));
  };
  NavigationState start{position(0.0), velocity(0.0), attitude(0.0)};
  const double dt = 0.02;
  Strapdown strapdown(start, dt);
  const int samples = 30000;  // ten minutes, 120 km
  for (int i = 0; i < samples; ++i) {
    const double t = i * dt;
    const auto rate = [&](double s) -> Vector3 { return u * normal + attitude(s).conjugate() * earth_rate(); };
    (void)strapdown.advance((rate(t) + 4.0 * rate(t + 0.5 * dt) + rate(t + dt)) / 6.0,
                            (force(t) + 4.0 * force(t + 0.5 * dt) + force(t + dt)) / 6.0);
  }
  const double end = samples * dt;
  EXPECT_LT((strapdown.state().position_ecef_m - position(end)).norm(), 1e-3);
  EXPECT_LT((strapdown.state().velocity_ecef_m_s - velocity(end)).norm(), 1e-5);
  EXPECT_LT(rotation_vector(strapdown.state().attitude * attitude(end).conjugate()).norm(), 1e-10);
}

double closure_m(const Motion& motion, double rate_hz) {
  const Trajectory truth = *make_trajectory(motion, rate_hz);
  Strapdown strapdown(truth.states.front(), truth.dt_s);
  double worst = 0.0;
  for (std::size_t i = 0; i < truth.imu.size(); ++i) {
    (void)strapdown.advance(rate_of(truth.imu[i]), force_of(truth.imu[i]));
    worst = std::max(worst, (strapdown.state().position_ecef_m - truth.states[i + 1].position_ecef_m).norm());
  }
  return worst;
}

TEST(Strapdown, ClosesThePapersDriveToAMillimetre) {
  for (const char* const name : {"paper", "paper-s-curves"}) {
    const OutageScenario scenario = *paper_scenario(name);
    const auto motion = *make_segment_motion(scenario.drive);
    const double worst = closure_m(*motion, 100.0);
    RecordProperty(name, std::to_string(worst));
    EXPECT_LT(worst, 1e-3) << name;
  }
}

TEST(Strapdown, ClosesARecordedTrajectoryWithClimbAndBank) {
  std::vector<RecordedPose> poses;
  for (int i = 0; i <= 120; ++i) {
    const double t = i;
    RecordedPose pose;
    pose.time_s = t;
    const double heading = 0.05 * t;
    pose.velocity_ned_m_s = {20.0 * std::cos(heading), 20.0 * std::sin(heading), 2.0 * std::sin(0.1 * t)};
    pose.attitude = {0.2 * std::sin(0.2 * t), 0.1 * std::cos(0.15 * t),
                     heading > 3.0 ? heading - 2.0 * std::numbers::pi : heading};
    poses.push_back(pose);
  }
  const auto motion = *make_recorded_motion({0.8, 0.2, 300.0}, poses);
  EXPECT_LT(closure_m(*motion, 100.0), 1e-3);
}

TEST(SegmentMotion, TurnsByRateTimesDurationWithoutAStepInTheRate) {
  const OutageScenario scenario = *paper_scenario("paper");
  const auto motion = *make_segment_motion(scenario.drive);
  EXPECT_NEAR(motion->at(89.9).attitude.heading_rad, 0.0, 1e-15);
  EXPECT_NEAR(motion->at(101.0).attitude.heading_rad, 90.0 * kDegree, 1e-12);
  EXPECT_NEAR(motion->at(480.0).attitude.heading_rad, 360.0 * kDegree, 1e-12);
  EXPECT_NEAR(motion->at(60.0).velocity_ned_m_s.norm(), 15.0, 1e-12);
  double before = 0.0;
  for (double t = 0.0; t < 480.0; t += 0.01) {
    const MotionState state = motion->at(t);
    EXPECT_LT(std::fabs(state.attitude_rate.heading_rad - before), 0.06 * 18.0 * kDegree);
    before = state.attitude_rate.heading_rad;
    // The derivative that is stated is the derivative.
    const Vector3 slope = (motion->at(t + 1e-5).velocity_ned_m_s - motion->at(t - 1e-5).velocity_ned_m_s) / 2e-5;
    ASSERT_LT((slope - state.acceleration_ned_m_s2).norm(), 1e-3) << t;
  }
}

TEST(SegmentMotion, StopsAndSpeaksOfImpossiblePlans) {
  SegmentPlan plan;
  plan.duration_s = 60.0;
  plan.speed_m_s = 10.0;
  plan.segments = {{.kind = SegmentKind::SCurve, .start_s = 5.0, .duration_s = 3.0, .rate_rad_s = 0.3},
                   {.kind = SegmentKind::Stop, .start_s = 30.0, .acceleration_m_s2 = 2.0}};
  const auto motion = *make_segment_motion(plan);
  EXPECT_NEAR(motion->at(59.0).velocity_ned_m_s.norm(), 0.0, 1e-12);
  EXPECT_NEAR(motion->at(20.0).attitude.heading_rad, 0.0, 1e-12);
  plan.segments[1].start_s = 2.0;
  EXPECT_EQ(make_segment_motion(plan).error().code, ErrorCode::InvalidArgument);
  plan.segments[1] = {.kind = SegmentKind::Turn, .start_s = 30.0, .duration_s = 0.0, .rate_rad_s = 0.1};
  EXPECT_EQ(make_segment_motion(plan).error().code, ErrorCode::InvalidArgument);
}

TEST(SegmentMotion, ChangesOfSpeedFollowEachOther) {
  // To 20 m/s at 1 m/s^2, over after 20.5 s. A stop at 10 m/s^2 from second 3 on would drive backwards: 20 m/s taken
  // from 5.
  SegmentPlan plan;
  plan.duration_s = 60.0;
  plan.segments = {{.kind = SegmentKind::Accelerate, .start_s = 0.0, .acceleration_m_s2 = 1.0, .until_speed_m_s = 20.0},
                   {.kind = SegmentKind::Stop, .start_s = 3.0, .acceleration_m_s2 = 10.0}};
  const auto refused = make_segment_motion(plan);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fields.front().value, "1");
  plan.segments[1].start_s = 20.4;
  EXPECT_FALSE(make_segment_motion(plan));
  plan.segments[1].start_s = 20.5;
  const auto motion = make_segment_motion(plan);
  ASSERT_TRUE(motion) << motion.error().message;
  for (double t = 0.0; t < 60.0; t += 0.1) {
    const double speed = (*motion)->at(t).velocity_ned_m_s.x();
    EXPECT_GE(speed, -1e-12) << t;
    EXPECT_LE(speed, 20.0 + 1e-12) << t;
  }
  // One that changes nothing is in nobody's way.
  plan.segments[1] = {
      .kind = SegmentKind::Accelerate, .start_s = 3.0, .acceleration_m_s2 = 1.0, .until_speed_m_s = 20.0};
  EXPECT_TRUE(make_segment_motion(plan));
}

TEST(RecordedPoses, LastFromTheFirstToTheLast) {
  std::vector<RecordedPose> poses(1);
  poses[0].time_s = 3.0;
  EXPECT_EQ(duration_of(poses), 0.0);
  poses.resize(3);
  poses[1].time_s = 4.0;
  poses[2].time_s = 9.5;
  EXPECT_EQ(duration_of(poses), 6.5);
}

}  // namespace
}  // namespace driftlab
