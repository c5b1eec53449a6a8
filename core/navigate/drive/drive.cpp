#include "core/navigate/drive/drive.hpp"

#include "core/navigate/earth.hpp"

#include <algorithm>

namespace driftlab::drive {

bool Drive::has_velocities() const {
  return std::any_of(fixes.begin(), fixes.end(), [](const Fix& fix) { return fix.velocity_ned_m_s.has_value(); });
}

Vector3 Drive::on_map(const Vector3& position_ecef_m) const {
  const Vector3& origin = reference.front().position_ecef_m;
  return ned_axes(origin).transpose() * (position_ecef_m - origin);
}

}  // namespace driftlab::drive
