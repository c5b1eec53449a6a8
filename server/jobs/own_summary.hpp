#pragma once
/// What a characterise job's recordings say together. What all recordings of the device say is pooled by a job of its
/// own (server/jobs/pool.cpp).
#include "core/analysis/characterise.hpp"
#include "schema/json/json.hpp"
#include "server/jobs/job_kind.hpp"

namespace driftlab::server {

/// Adds `replicates` and `trends` of the job's own recordings to its document; members go by the ids in `results`.
/// Recordings of several devices in one job say nothing together. Errors: those of the store; Cancelled.
[[nodiscard]] Status add_own_summary(Json& document, const std::vector<CharacterisedRecording>& recordings,
                                     JobContext& context, const RunControl& control, const JobResults& results);

}  // namespace driftlab::server
