#include "core/navigate/drive/drive.hpp"

#include "core/navigate/earth.hpp"

namespace driftlab::drive {

Vector3 Drive::on_map(const Vector3& position_ecef_m) const {
  const Vector3& origin = reference.front().position_ecef_m;
  return ned_axes(origin).transpose() * (position_ecef_m - origin);
}

}  // namespace driftlab::drive
