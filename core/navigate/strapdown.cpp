#include "core/navigate/strapdown.hpp"

namespace driftlab {
namespace {

/// -2 w_ie x v.
Vector3 coriolis(const Vector3& v) { return {2.0 * kEarthRate * v.y(), -2.0 * kEarthRate * v.x(), 0.0}; }

}  // namespace

Strapdown::Strapdown(const NavigationState& start, double dt_s)
    : state_(start),
      attitude_(start.attitude.toRotationMatrix()),
      dt_s_(dt_s),
      half_earth_angle_(0.5 * kEarthRate * dt_s) {}

StrapdownStep Strapdown::advance(const Vector3& rate, const Vector3& force) {
  const Vector3 angle = rate * dt_s_;
  const Vector3 gained = force * dt_s_;
  if (first_) {  // nothing is known of the sample before: as if the motion had been the same
    angle_before_ = angle;
    velocity_before_ = gained;
    first_ = false;
  }
  const Vector3 phi = angle + angle_before_.cross(angle) / 12.0;
  const Vector3 turning = angle.cross(gained);
  const Vector3 body_gain = gained + 0.5 * turning + angle.cross(turning) / 6.0 +
                            (angle_before_.cross(gained) + velocity_before_.cross(angle)) / 12.0;
  angle_before_ = angle;
  velocity_before_ = gained;

  StrapdownStep step;
  const Vector3 unturned = attitude_ * body_gain;
  // (I - [w_ie x] dt/2): the frame turns under the velocity gained.
  step.velocity_gained = {unturned.x() + half_earth_angle_ * unturned.y(),
                          unturned.y() - half_earth_angle_ * unturned.x(), unturned.z()};

  const Vector3 v = state_.velocity_ecef_m_s;
  const Vector3 gravity = normal_gravity(state_.position_ecef_m + (0.5 * dt_s_) * v);
  const Vector3 half_gained = 0.5 * (step.velocity_gained + dt_s_ * (gravity + coriolis(v)));
  const Vector3 pull = gravity + coriolis(v + half_gained);
  state_.velocity_ecef_m_s = v + step.velocity_gained + dt_s_ * pull;
  state_.position_ecef_m += (0.5 * dt_s_) * (v + state_.velocity_ecef_m_s);

  // R(-w_ie dt) q R(phi): the first factor is (1, 0, 0, -w dt/2) to second order in 4e-7 rad.
  const Quaternion turned = state_.attitude * rotation(phi);
  const double h = half_earth_angle_;
  Quaternion next(turned.w() + h * turned.z(), turned.x() + h * turned.y(), turned.y() - h * turned.x(),
                  turned.z() - h * turned.w());
  // The norm drifts by rounding and h^2 alone: one Newton step keeps it at 1.
  next.coeffs() *= 1.5 - 0.5 * next.squaredNorm();
  state_.attitude = next;
  const Matrix3 after = next.toRotationMatrix();
  step.attitude_middle = 0.5 * (attitude_ + after);
  attitude_ = after;
  return step;
}

void Strapdown::correct(const Vector3& position, const Vector3& velocity, const Vector3& phi) {
  state_.position_ecef_m += position;
  state_.velocity_ecef_m_s += velocity;
  state_.attitude = rotation(phi) * state_.attitude;
  state_.attitude.normalize();
  attitude_ = state_.attitude.toRotationMatrix();
}

}  // namespace driftlab
