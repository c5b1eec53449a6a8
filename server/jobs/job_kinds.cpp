#include "server/jobs/characterise.hpp"
#include "server/jobs/investigate.hpp"
#include "server/jobs/job_kind.hpp"
#include "server/jobs/outage_evaluation.hpp"

namespace driftlab::server {

const std::vector<std::unique_ptr<JobKind>>& job_kinds() {
  static const std::vector<std::unique_ptr<JobKind>> kinds = [] {
    std::vector<std::unique_ptr<JobKind>> list;
    list.push_back(make_characterise_kind());
    list.push_back(make_outage_evaluation_kind());
    list.push_back(make_investigate_kind());
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
