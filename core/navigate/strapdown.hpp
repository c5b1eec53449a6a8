#pragma once
/// Strapdown mechanisation in the Earth-fixed frame.
///
/// With increments a = w dt (angle) and u = f dt (velocity) of this sample and a', u' of the one before, the rotation
/// vector and the velocity gained over a sample are (Savage 1998; Titterton and Weston 2004, ch. 11)
///   phi = a + (a' x a)/12                                   coning,
///   s   = u + (a x u)/2 + a x (a x u)/6 + (a' x u + u' x a)/12   rotation and sculling.
/// The third term of s is small but does not average out: without it a turn of 90 deg at 18 deg/s and 100 Hz leaves a
/// velocity wrong by 4e-5 m/s, centimetres after minutes. Attitude: C <- R(-w_ie dt) C R(phi). Velocity: v += (I -
/// [w_ie x] dt/2) C s + (g(r) - 2 w_ie x v) dt, gravity and Coriolis at the middle of the sample; position by the
/// trapezoid of velocity with the acceleration's change left out (error dt^2/12 times the change of acceleration: 4e-5
/// m at 100 Hz for a road turn).
#include "core/navigate/trajectory.hpp"

namespace driftlab {

/// What the covariance needs to know of a step: how attitude and force lay in e.
struct StrapdownStep {
  Matrix3 attitude_middle;  ///< C in the middle of the sample, mean of both ends
  Vector3 velocity_gained;  ///< integral of C f over the sample [m/s], gravity left out
};

class Strapdown {
 public:
  Strapdown() = default;
  Strapdown(const NavigationState& start, double dt_s);

  /// One sample: mean rate [rad/s] and mean specific force [m/s^2] over dt, errors already taken off.
  StrapdownStep advance(const Vector3& rate, const Vector3& force);

  [[nodiscard]] const NavigationState& state() const { return state_; }
  [[nodiscard]] const Matrix3& attitude() const { return attitude_; }  ///< b -> e as a matrix

  /// Takes the filter's correction: true = estimate + error, true C = (I + [phi x]) C.
  void correct(const Vector3& position, const Vector3& velocity, const Vector3& phi);

 private:
  NavigationState state_;
  Matrix3 attitude_ = Matrix3::Identity();
  Vector3 gravity_ = Vector3::Zero();
  Vector3 angle_before_ = Vector3::Zero();
  Vector3 velocity_before_ = Vector3::Zero();
  double dt_s_ = 0.0;
  double half_earth_angle_ = 0.0;
  bool first_ = true;
};

}  // namespace driftlab
