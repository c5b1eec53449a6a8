#pragma once
/// A kind of job: one declaring file and one line in the registry (job_kinds.cpp).
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"
#include "schema/json/json.hpp"
#include "server/jobs/job_cost.hpp"
#include "server/store/blobs.hpp"
#include "server/store/budgets.hpp"
#include "server/store/store.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// What a running job may use.
struct JobContext {
  Store& store;
  BlobStore& blobs;
  const Clock& clock;
  Budgets budgets = {};
  /// Makes sure that the columns of a blob are what was written, before they are used; may be empty. Errors: Io, for
  /// columns that are damaged and cannot be made anew.
  std::function<Status(const std::string& sha256)> verify_columns = {};
  int computing = 0;  ///< threads that jobs share; 0: one for each core
};

class JobParts;

class JobKind {
 public:
  JobKind() = default;
  JobKind(const JobKind&) = delete;
  JobKind& operator=(const JobKind&) = delete;
  virtual ~JobKind() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;

  /// The version of its algorithm, `algorithm_version` of each request. It goes up where results change, and where a
  /// request has a member that the version before does not know: a process takes no job of a later version.
  [[nodiscard]] virtual int version() const { return 1; }

  /// Checks a request (`inputs` and `parameters` of POST /v1/jobs) and completes it: defaults filled in, input
  /// revisions pinned. With the version its canonical text makes the job unique. Errors are the client's fault,
  /// located by fields that are pointers (RFC 6901).
  [[nodiscard]] virtual Result<Json> canonical_request(const Json& inputs, const Json& parameters,
                                                       JobContext& context) const = 0;

  /// What the job of a canonical request will take at most, roughly. Unless a kind says more: little.
  [[nodiscard]] virtual JobCost cost(const Json& /*request*/, JobContext& /*context*/) const { return {}; }

  /// Does the work that a canonical request describes. Runs on a worker thread, polls `control.stop`, reports progress.
  /// Must not write to the store.
  [[nodiscard]] virtual Result<JobResults> run(const Json& request, JobContext& context,
                                               const RunControl& control) const = 0;

  /// The same where other workers may help: what of the work can be divided goes through `parts` (job_parts.hpp). A
  /// kind whose work cannot leaves this to `run`.
  [[nodiscard]] virtual Result<JobResults> run_in_parts(const Json& request, JobContext& context,
                                                        const RunControl& control, JobParts& /*parts*/) const {
    return run(request, context, control);
  }
};

/// The job that `inputs` and `parameters` ask of `kind`, ready to be queued: its request is the canonical text (sorted
/// members, no white space), its unique key that text's SHA-256. Errors: those of canonical_request; LimitExceeded for
/// one that would take more memory than all jobs have.
[[nodiscard]] Result<NewJob> new_job(const JobKind& kind, const Json& inputs, const Json& parameters,
                                     JobContext& context);

/// Every kind once.
[[nodiscard]] const std::vector<std::unique_ptr<JobKind>>& job_kinds();

/// The kind of that name, or nullptr.
[[nodiscard]] const JobKind* find_job_kind(std::string_view name);

}  // namespace driftlab::server
