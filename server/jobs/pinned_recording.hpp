#pragma once
/// A recording as a job's request names it: the very revision that was there when the job was queued.
#include "schema/json/recording_spec.hpp"
#include "server/jobs/job_kind.hpp"

namespace driftlab::server {

struct PinnedRecording {
  Recording recording;
  RecordingSpec spec;  ///< its metadata
};

/// `input` has the members `id` and `revision`. Errors: NotFound; Conflict where the recording was revised since; those
/// of the store.
[[nodiscard]] Result<PinnedRecording> pinned_recording(const Json& input, JobContext& context);

}  // namespace driftlab::server
