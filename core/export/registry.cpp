/// The list of export targets: one line each. Each is defined in core/export/targets/, in the file of its name.
#include "core/export/target.hpp"

#include <algorithm>

// clang-format off
#define DRIFTLAB_EXPORT_TARGETS(TARGET) \
  TARGET(kalibr)                        \
  TARGET(vins_fusion)                   \
  TARGET(orb_slam3)                     \
  TARGET(openvins)                      \
  TARGET(gtsam)                         \
  TARGET(kf_gins)                       \
  TARGET(navego)                        \
  TARGET(gnss_ins_sim)                  \
  TARGET(px4)                           \
  TARGET(ardupilot)                     \
  TARGET(robot_localization)            \
  TARGET(imu_tools)                     \
  TARGET(gazebo)                        \
  TARGET(isaac)
// clang-format on

namespace driftlab {

#define DRIFTLAB_DECLARE_TARGET(name) ExportTarget name##_target();
DRIFTLAB_EXPORT_TARGETS(DRIFTLAB_DECLARE_TARGET)
#undef DRIFTLAB_DECLARE_TARGET

std::span<const ExportTarget> export_targets() {
#define DRIFTLAB_MAKE_TARGET(name) name##_target(),
  static const std::vector<ExportTarget> targets{DRIFTLAB_EXPORT_TARGETS(DRIFTLAB_MAKE_TARGET)};
#undef DRIFTLAB_MAKE_TARGET
  return targets;
}

Result<const ExportTarget*> find_export_target(std::string_view name) {
  const auto targets = export_targets();
  const auto found =
      std::find_if(targets.begin(), targets.end(), [&](const ExportTarget& target) { return target.name == name; });
  if (found != targets.end()) {
    return &*found;
  }
  std::string known;
  for (const ExportTarget& target : targets) {
    known.append(known.empty() ? "" : ", ").append(target.name);
  }
  return fail(ErrorCode::InvalidArgument,
              "There is no export target '" + std::string(name) + "'. Known are " + known + ".",
              {{"parameter", "target"}});
}

}  // namespace driftlab
