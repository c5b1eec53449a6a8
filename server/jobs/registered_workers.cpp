/// The constructor that daemons use. It alone needs the registry of kinds, and with it all that the kinds link.
#include "server/jobs/worker_pool.hpp"

#include <utility>

namespace driftlab::server {
namespace {

WorkerOptions with_known_kinds(WorkerOptions options) {
  for (const auto& kind : job_kinds()) {
    options.known.push_back({std::string(kind->name()), kind->version()});
  }
  return options;
}

}  // namespace

WorkerPool::WorkerPool(JobContext context, WorkerOptions options,
                       std::function<void(const std::string& job_id)> changed)
    : WorkerPool(std::move(context), with_known_kinds(std::move(options)), std::move(changed), find_job_kind) {}

}  // namespace driftlab::server
