#pragma once
/// The columns of a job in the order that `read_job` reads them, shared by the two files that return jobs.
#include "server/store/sql/tables.hpp"

/// Constant text: string literals next to each other are one.
#define DRIFTLAB_JOB_COLUMNS                                                                                \
  "id, kind, state, stage, progress, priority, attempt, failures, max_failures, unique_key, request_json, " \
  "cancel_requested, run_at, lease_expires_at, created_at, started_at, finished_at, problem_json, seal"

namespace driftlab::server::tables {

/// `is_damaged` tells whether the request is not what was written: who works with it has to look.
[[nodiscard]] Job read_job(const Statement& row);

}  // namespace driftlab::server::tables
