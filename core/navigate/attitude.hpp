#pragma once
/// Attitudes as unit quaternions. q_ab transforms the components of a vector from frame b to frame a: v_a = q_ab * v_b.
///
/// Euler angles are roll, pitch and heading of the body relative to n, applied in the order heading, pitch, roll
/// (aerospace convention). At a pitch of +-90 deg roll and heading are not unique; roll is then set to 0.
#include "core/navigate/earth.hpp"

#include <Eigen/Geometry>

#include <cmath>

namespace driftlab {

using Quaternion = Eigen::Quaterniond;

struct EulerAngles {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double heading_rad = 0.0;
};

/// Quaternion of a rotation vector: |phi| radians about its direction.
///
/// Half-angle sine and cosine by their series up to 0.1 rad (next term below 1e-17 there), by the functions beyond.
[[nodiscard]] inline Quaternion rotation(const Vector3& phi) {
  const double squared = 0.25 * phi.squaredNorm();
  double cosine = 0.0;
  double half_sinc = 0.0;
  if (squared < 0.0025) {
    cosine = 1.0 - squared * (0.5 - squared * (1.0 / 24.0 - squared * (1.0 / 720.0 - squared / 40320.0)));
    half_sinc = 0.5 * (1.0 - squared * (1.0 / 6.0 - squared * (1.0 / 120.0 - squared * (1.0 / 5040.0))));
  } else {
    const double half = std::sqrt(squared);
    cosine = std::cos(half);
    half_sinc = 0.5 * std::sin(half) / half;
  }
  return {cosine, half_sinc * phi.x(), half_sinc * phi.y(), half_sinc * phi.z()};
}

/// Rotation vector of a quaternion, its angle at most pi.
[[nodiscard]] inline Vector3 rotation_vector(const Quaternion& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sine = q.vec().norm();
  if (sine < 1e-12) {
    return 2.0 * sign * q.vec();
  }
  return (2.0 * std::atan2(sine, sign * q.w()) / sine * sign) * q.vec();
}

/// b -> n.
[[nodiscard]] inline Quaternion from_euler(const EulerAngles& angles) {
  return Eigen::AngleAxisd(angles.heading_rad, Vector3::UnitZ()) *
         Eigen::AngleAxisd(angles.pitch_rad, Vector3::UnitY()) * Eigen::AngleAxisd(angles.roll_rad, Vector3::UnitX());
}

[[nodiscard]] inline EulerAngles to_euler(const Quaternion& q_nb) {
  const Matrix3 c = q_nb.toRotationMatrix();
  const double level = std::hypot(c(0, 0), c(1, 0));
  EulerAngles angles;
  angles.pitch_rad = std::atan2(-c(2, 0), level);
  if (level > 1e-9) {
    angles.roll_rad = std::atan2(c(2, 1), c(2, 2));
    angles.heading_rad = std::atan2(c(1, 0), c(0, 0));
  } else {
    angles.heading_rad = std::atan2(-c(0, 1), c(1, 1));
  }
  return angles;
}

}  // namespace driftlab
