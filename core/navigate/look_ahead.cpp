#include "core/navigate/look_ahead.hpp"

#include <cmath>

namespace driftlab {
namespace {

constexpr double kSlow = 0.5;  ///< [m/s]

double level_speed(const RecordedPose& pose) {
  return std::hypot(pose.velocity_ned_m_s.x(), pose.velocity_ned_m_s.y());
}

double heading_of(const RecordedPose& pose) { return std::atan2(pose.velocity_ned_m_s.y(), pose.velocity_ned_m_s.x()); }

}  // namespace

void look_ahead(std::vector<RecordedPose>& poses, UnknownAngles unknown) {
  EulerAngles held;
  for (const RecordedPose& pose : poses) {
    if (level_speed(pose) >= kSlow) {
      held.heading_rad = heading_of(pose);
      break;
    }
  }
  for (RecordedPose& pose : poses) {
    if (level_speed(pose) >= kSlow) {
      held.heading_rad = heading_of(pose);
      held.pitch_rad = std::atan2(-pose.velocity_ned_m_s.z(), level_speed(pose));
    }
    if (unknown.heading) {
      pose.attitude.heading_rad = held.heading_rad;
    }
    if (unknown.pitch) {
      pose.attitude.pitch_rad = held.pitch_rad;
    }
  }
}

}  // namespace driftlab
