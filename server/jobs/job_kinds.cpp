/// The registry: one line per kind, which names the function that makes it. Each is defined in the file of its name.
#include "server/jobs/job_kind.hpp"

// clang-format off
#define DRIFTLAB_JOB_KINDS(KIND)       \
  KIND(make_characterise_kind)         \
  KIND(make_pool_kind)                 \
  KIND(make_outage_evaluation_kind)    \
  KIND(make_drive_evaluation_kind)     \
  KIND(make_investigate_kind)          \
  KIND(make_regress_kind)
// clang-format on

namespace driftlab::server {

#define DRIFTLAB_DECLARE_KIND(make) std::unique_ptr<JobKind> make();
DRIFTLAB_JOB_KINDS(DRIFTLAB_DECLARE_KIND)
#undef DRIFTLAB_DECLARE_KIND

const std::vector<std::unique_ptr<JobKind>>& job_kinds() {
  static const std::vector<std::unique_ptr<JobKind>> kinds = [] {
    std::vector<std::unique_ptr<JobKind>> list;
#define DRIFTLAB_ENTER_KIND(make) list.push_back(make());
    DRIFTLAB_JOB_KINDS(DRIFTLAB_ENTER_KIND)
#undef DRIFTLAB_ENTER_KIND
    return list;
  }();
  return kinds;
}

const JobKind* find_job_kind(std::string_view name) {
  for (const auto& kind : job_kinds()) {
    if (kind->name() == name) {
      return kind.get();
    }
  }
  return nullptr;
}

}  // namespace driftlab::server
