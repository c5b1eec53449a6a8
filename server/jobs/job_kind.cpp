#include "server/jobs/job_kind.hpp"

#include "server/store/digest.hpp"

namespace driftlab::server {

Result<NewJob> new_job(const JobKind& kind, const Json& inputs, const Json& parameters, JobContext& context) {
  auto request = kind.canonical_request(inputs, parameters, context);
  if (!request) {
    return fail(request.error());
  }
  (*request)["algorithm_version"] = kind.version();
  if (auto admitted = admit_cost(kind.cost(*request, context), context.budgets, context.computing); !admitted) {
    return fail(admitted.error());
  }
  NewJob job;
  job.kind = kind.name();
  job.request_json = canonical_text(*request);
  job.unique_key = sha256_hex(job.request_json);
  return job;
}

}  // namespace driftlab::server
