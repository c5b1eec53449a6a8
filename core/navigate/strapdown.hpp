#pragma once
/// Strapdown mechanisation in the Earth-fixed frame.
///
/// Let a = w dt (angle) and u = f dt (velocity) be the increments of this sample and a', u' those of the one before.
/// The rotation vector and the velocity gained over a sample are (Savage 1998; Titterton and Weston 2004, ch. 11)
///   phi = a + (a' x a)/12                                        coning,
///   s   = u + (a x u)/2 + a x (a x u)/6 + (a' x u + u' x a)/12   rotation and sculling.
/// The third term of s is small but does not average out: without it a turn of 90 deg at 18 deg/s and 100 Hz leaves a
/// velocity error of 4e-5 m/s, which becomes centimetres after minutes.
///
/// Attitude: C <- R(-w_ie dt) C R(phi). Velocity: v += (I - [w_ie x] dt/2) C s + (g(r) - 2 w_ie x v) dt, with gravity
/// and Coriolis terms in the middle of the sample. Position: trapezoidal integration of the velocity, which neglects
/// the change of acceleration within the sample (error dt^2/12 times that change: 4e-5 m at 100 Hz for a road turn).
#include "core/navigate/trajectory.hpp"

namespace driftlab {

/// The quantities of a step that the covariance propagation needs: attitude and velocity increment in e.
struct StrapdownStep {
  Matrix3 attitude_middle;  ///< C in the middle of the sample, mean of both ends
  Vector3 velocity_gained;  ///< integral of C f over the sample [m/s], gravity left out
};

class Strapdown {
 public:
  Strapdown() = default;
  Strapdown(const NavigationState& start, double dt_s);

  /// Advances by one sample: mean rate [rad/s] and mean specific force [m/s^2] over dt, already corrected for estimated
  /// errors.
  StrapdownStep advance(const Vector3& rate, const Vector3& force);

  [[nodiscard]] const NavigationState& state() const { return state_; }
  [[nodiscard]] const Matrix3& attitude() const { return attitude_; }  ///< b -> e as a matrix

  /// Applies the filter's correction: true = estimate + error, true C = (I + [phi x]) C.
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
