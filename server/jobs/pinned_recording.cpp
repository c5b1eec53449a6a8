#include "server/jobs/pinned_recording.hpp"

namespace driftlab::server {

Result<PinnedRecording> pinned_recording(const Json& input, JobContext& context) {
  auto recording = context.store.recording(input["id"].get<std::string>());
  if (!recording) {
    return fail(recording.error());
  }
  if (recording->revision != input["revision"].get<std::int64_t>()) {
    return fail(ErrorCode::Conflict,
                "The recording " + recording->id + " was revised after the job was queued; queue it again.");
  }
  auto metadata = parse_json(recording->metadata_json);
  if (!metadata) {
    return fail(metadata.error());
  }
  Faults faults;
  RecordingSpec spec = recording_spec_from_json(*metadata, "", faults);
  if (!faults.none()) {
    return fail(faults.error());
  }
  return PinnedRecording{std::move(*recording), std::move(spec)};
}

}  // namespace driftlab::server
