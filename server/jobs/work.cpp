#include "server/jobs/work.hpp"

#include "server/jobs/fault_recorder.hpp"

#include <utility>

namespace driftlab::server {

RunControl charged_to(const Lease& lease, Executor& executor, std::stop_token stop) {
  RunControl control;
  control.stop = std::move(stop);
  control.threads.executor = &executor;
  control.threads.around = [&lease](const std::function<void()>& helping) {
    const FaultScope scope(lease);
    helping();
  };
  return control;
}

}  // namespace driftlab::server
