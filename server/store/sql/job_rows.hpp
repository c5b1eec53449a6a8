#pragma once
/// The columns of a job in the order that `read_job` reads them, and which jobs a process can run: what the files that
/// return jobs share.
#include "server/store/sql/tables.hpp"

/// Constant text: string literals next to each other are one.
#define DRIFTLAB_JOB_COLUMNS                                                                                \
  "id, kind, state, stage, progress, priority, attempt, failures, max_failures, unique_key, request_json, " \
  "cancel_requested, run_at, lease_expires_at, created_at, started_at, finished_at, problem_json, seal, end_seal"

/// Whether a process can run a job; KNOWN is the parameter that holds what `can_run` writes. A canonical request begins
/// with its version, for its members are sorted.
#define DRIFTLAB_CAN_RUN(KNOWN)                                                                               \
  "(" KNOWN                                                                                                   \
  " = '[]' OR jobs.kind || ' ' || CASE substr(jobs.request_json, 1, 21) WHEN '{\"algorithm_version\":' THEN " \
  "substr(jobs.request_json, 22, CAST(instr(substr(jobs.request_json, 22, 12) || ',', ',') AS INTEGER) - 1) " \
  "ELSE '0' END IN (SELECT value FROM json_each(" KNOWN ")))"

namespace driftlab::server::tables {

/// `is_damaged` tells whether a seal does not fit or the state is none: who works with it has to look.
[[nodiscard]] Job read_job(const Statement& row);

/// `["pool 0","pool 1"]`: each kind with every version up to the one that the process has; names are plain words.
[[nodiscard]] std::string can_run(const std::vector<KnownKind>& known);

}  // namespace driftlab::server::tables
