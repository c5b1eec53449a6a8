#pragma once
/// A recorded trajectory as a motion: velocities and attitude angles interpolated by natural cubic splines.
///
/// The spline is the twice differentiable curve of least curvature through the samples, so specific force and angular
/// rates are continuous; between its samples the recording gives no information. Angles are unwrapped first. Position
/// is integrated from the velocities, and therefore follows the recorded velocities, not the recorded positions.
#include "core/navigate/motion.hpp"
#include "core/signal/result.hpp"

#include <memory>
#include <vector>

namespace driftlab {

struct RecordedPose {
  double time_s = 0.0;
  Vector3 velocity_ned_m_s = Vector3::Zero();
  EulerAngles attitude;
};

/// From the first pose to the last [s]; `poses` are not empty.
[[nodiscard]] inline double duration_of(const std::vector<RecordedPose>& poses) {
  return poses.back().time_s - poses.front().time_s;
}

/// Time 0 of the motion is that of the first pose. Errors: TooFewSamples (fewer than 4), NonMonotonicTime, NonFinite.
[[nodiscard]] Result<std::unique_ptr<Motion>> make_recorded_motion(const Geodetic& start,
                                                                   const std::vector<RecordedPose>& poses);

}  // namespace driftlab
