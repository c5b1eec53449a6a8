#pragma once
/// The attitude of a vehicle of which only velocities were recorded: its nose is taken to point along the velocity.
#include "core/navigate/recorded_motion.hpp"

#include <vector>

namespace driftlab {

/// Angles that a recorded trajectory does not have.
struct UnknownAngles {
  bool pitch = false;
  bool heading = false;
};

/// A trajectory as somebody recorded it; angles that it does not have are 0 in every pose.
struct RecordedTrajectory {
  std::vector<RecordedPose> poses;
  UnknownAngles unknown;
};

/// Puts heading and pitch of the velocity in place of the unknown angles. Below 0.5 m/s a velocity has no direction
/// worth following and the last angles stay; before the first faster pose the heading is that of this one, and the
/// pitch 0. A trajectory that is never so fast keeps both at 0. O(poses).
void look_ahead(std::vector<RecordedPose>& poses, UnknownAngles unknown);

}  // namespace driftlab
