#pragma once
/// Named points at which a test may kill the process, to prove that nothing acknowledged is lost and nothing is half
/// done.
///
/// In production a crash point is one relaxed atomic load. When the daemon was started with the environment variable
/// DRIFTLAB_CRASH_AT=<name>, reaching the point raises SIGKILL in the own process: no destructor, no flush, like a
/// power cut of the process. The names are a closed list, so that the crash suite can walk it.
#include <string_view>
#include <vector>

namespace driftlab::server {

/// Every name that `crash_point` is called with. tests/crash walks this list through `driftlabd crash-points`.
[[nodiscard]] const std::vector<std::string_view>& crash_point_names();

/// Arms one name; empty disarms. Called once by main before threads start. False: the name is not in the list.
[[nodiscard]] bool arm_crash_point(std::string_view name);

/// Dies here if armed with this name.
void crash_point(std::string_view name);

}  // namespace driftlab::server
