#pragma once
/// The true motion of a vehicle: velocity and attitude in n as smooth functions of time.
///
/// Position follows by integration (core/navigate/trajectory.hpp). A motion therefore provides only velocity and
/// attitude with their derivatives, from which specific force and angular rate follow without numerical
/// differentiation.
#include "core/navigate/attitude.hpp"

namespace driftlab {

struct MotionState {
  Vector3 velocity_ned_m_s = Vector3::Zero();
  Vector3 acceleration_ned_m_s2 = Vector3::Zero();  ///< derivative of the three velocity components
  EulerAngles attitude;
  EulerAngles attitude_rate;  ///< derivatives of the three angles [rad/s]
};

class Motion {
 public:
  Motion() = default;
  Motion(const Motion&) = delete;
  Motion& operator=(const Motion&) = delete;
  virtual ~Motion() = default;

  [[nodiscard]] virtual Geodetic start() const = 0;
  [[nodiscard]] virtual double duration_s() const = 0;
  /// At a time from 0 to the duration; beyond either end as if the motion went on.
  [[nodiscard]] virtual MotionState at(double time_s) const = 0;
};

}  // namespace driftlab
