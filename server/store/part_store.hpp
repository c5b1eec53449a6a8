#pragma once
/// The parts into which a running job is divided, so that several workers may compute it (server/jobs/job_parts.hpp).
///
///     open ---- claim ----> running ---- finish ----> finished
///      ^                      |
///      +------ put back ------+
///
/// A part whose lease ran out is left to the job's own worker: what killed one helper kills no second one.
/// What a part found is kept until the job ends: whoever runs the job again after a lost worker goes on from there.
#include "server/store/store.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// A worker's claim on a part: `claim` fences off a worker that lost it.
struct PartClaim {
  std::string job_id;
  std::int64_t number = 0;
  std::int64_t claim = 0;
};

class PartStore {
 public:
  PartStore() = default;
  PartStore(const PartStore&) = delete;
  PartStore& operator=(const PartStore&) = delete;
  virtual ~PartStore() = default;

  /// Divides a job into parts 0 to `count` - 1 for workers of the same program. What an earlier attempt of that program
  /// at as many parts has found stays. `held` false: the lease is lost, nothing was done.
  [[nodiscard]] virtual Result<LeaseStatus> divide(const Lease& lease, std::int64_t count,
                                                   std::string_view program) = 0;
  /// A running job with parts that nobody has begun, of that program and of a kind that is `known` (nothing known: of
  /// any), by priority and age; nothing if there is none.
  [[nodiscard]] virtual Result<std::optional<Job>> job_to_help(const std::vector<KnownKind>& known,
                                                               std::string_view program) = 0;
  /// The first part that nobody has begun; for the job's own worker also one whose lease ran out.
  [[nodiscard]] virtual Result<std::optional<PartClaim>> claim_part(std::string_view job_id, bool own,
                                                                    std::int64_t lease_micros) = 0;
  /// `held` false: another worker has the part, or the job has ended; stop.
  [[nodiscard]] virtual Result<LeaseStatus> renew_part(const PartClaim& claim, std::int64_t lease_micros) = 0;
  [[nodiscard]] virtual Result<LeaseStatus> finish_part(const PartClaim& claim, std::string_view result) = 0;
  /// Gives a part up unfinished.
  [[nodiscard]] virtual Result<LeaseStatus> put_back_part(const PartClaim& claim) = 0;
  /// What the parts `first`, `first` + 1, ... found, up to the first that is not finished, `limit` at most.
  [[nodiscard]] virtual Result<std::vector<std::string>> finished_parts(std::string_view job_id, std::int64_t first,
                                                                        int limit) = 0;
  /// How many parts of the job are finished, whichever.
  [[nodiscard]] virtual Result<std::int64_t> count_finished_parts(std::string_view job_id) = 0;
};

}  // namespace driftlab::server
