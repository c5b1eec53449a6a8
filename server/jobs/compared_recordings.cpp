#include "server/jobs/compared_recordings.hpp"

#include "schema/json/compared_recording.hpp"
#include "schema/json/regression.hpp"

#include <utility>

namespace driftlab::server {
namespace {

/// A row and the results of its channels, of which there is at least one.
Result<regression::ComparedRecording> compared(const Recording& row, const std::vector<ChannelResult>& results) {
  const auto quality = parse_json(row.quality_json);
  if (!quality) {
    return fail(ErrorCode::Internal, "The stored recording " + row.id + " cannot be read.");
  }
  regression::ComparedRecording recording;
  recording.id = row.id;
  recording.condition = row.condition;
  for (const ChannelResult& result : results) {
    const auto document = parse_json(result.document_json);
    auto channel = document ? compared_channel_from_json(*document, *quality) : fail(document.error());
    if (!channel) {
      return fail(channel.error());
    }
    recording.channels.push_back(std::move(*channel));
  }
  recording.time_by_channels();
  tell_quality(*quality, recording);
  return recording;
}

/// The results of a recording where they are those that were pinned. Error: Cancelled.
Result<const std::vector<ChannelResult>*> pinned_results(const Json& pinned, const std::string& id,
                                                         const ResultsByRecording& results) {
  const auto found = results.find(id);
  Json ids = Json::array();
  if (found != results.end()) {
    for (const ChannelResult& result : found->second) {
      ids.push_back(result.id);
    }
  }
  if (ids.empty() || ids != pinned["results"]) {
    return fail(ErrorCode::Cancelled, "The recording " + id + " has newer results; ask for the run again.");
  }
  return &found->second;
}

}  // namespace

Result<ResultsByRecording> results_by_recording(Store& store, const std::string& device_id, const std::stop_token& stop,
                                                const std::set<std::string>& only) {
  ResultsByRecording results;
  for (const Quantity quantity : {Quantity::AngularRate, Quantity::SpecificForce}) {
    for (const char* const axis : {"x", "y", "z"}) {
      if (stop.stop_requested()) {
        return fail(ErrorCode::Cancelled, "The regression run was cancelled.");
      }
      auto latest = store.latest_channel_results(device_id, driftlab::name_of(quantity), axis);
      if (!latest) {
        return fail(latest.error());
      }
      for (ChannelResult& result : *latest) {
        if (only.empty() || only.contains(result.recording_id)) {
          results[result.recording_id].push_back(std::move(result));
        }
      }
    }
  }
  return results;
}

Result<regression::Recordings> compared_recordings(Store& store, const Json& arm, const ResultsByRecording& results,
                                                   const std::stop_token& stop) {
  regression::Recordings recordings{arm["label"].get<std::string>(), {}};
  for (const Json& pinned : arm["recordings"]) {
    if (stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The regression run was cancelled.");
    }
    const std::string id = pinned["recording"].get<std::string>();
    const auto row = store.recording(id);
    const auto found = row ? pinned_results(pinned, id, results) : fail(row.error());
    auto recording = found ? compared(*row, **found) : fail(found.error());
    if (!recording) {
      return fail(recording.error());
    }
    recording->session = pinned.value("session", "");
    if (const std::string time = pinned.value("recorded_at", ""); !time.empty()) {
      if (const auto seconds = seconds_of(time)) {
        recording->began_s = *seconds;
      }
    }
    stated_facts_of(pinned).tell(*recording);
    recordings.recordings.push_back(std::move(*recording));
  }
  return recordings;
}

}  // namespace driftlab::server
