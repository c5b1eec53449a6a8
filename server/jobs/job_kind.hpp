#pragma once
/// A kind of job: one declaring file and one line in the registry (job_kinds.cpp).
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"
#include "server/store/blobs.hpp"
#include "server/store/store.hpp"

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
};

class JobKind {
 public:
  JobKind() = default;
  JobKind(const JobKind&) = delete;
  JobKind& operator=(const JobKind&) = delete;
  virtual ~JobKind() = default;

  [[nodiscard]] virtual std::string_view name() const = 0;

  /// Checks a request (`inputs` and `parameters` of POST /v1/jobs as JSON text) and returns the canonical document
  /// whose SHA-256 makes the job unique: sorted members, defaults filled in, input revisions pinned, seed and algorithm
  /// version. Errors are the client's fault, located by field "pointer" (RFC 6901).
  [[nodiscard]] virtual Result<std::string> canonical_request(std::string_view inputs_json,
                                                              std::string_view parameters_json,
                                                              JobContext& context) const = 0;

  /// Does the work. Runs on a worker thread, polls `control.stop`, reports progress. Must not write to the store.
  [[nodiscard]] virtual Result<JobResults> run(std::string_view request_json, JobContext& context,
                                               const RunControl& control) const = 0;
};

/// Every kind once.
[[nodiscard]] const std::vector<std::unique_ptr<JobKind>>& job_kinds();

/// The kind of that name, or nullptr.
[[nodiscard]] const JobKind* find_job_kind(std::string_view name);

}  // namespace driftlab::server
