#include "server/jobs/own_summary.hpp"

#include "schema/json/campaign_summary.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

/// The job's own sources with the ids under which they will be stored.
std::vector<SensorSources> own_sensors(const std::vector<CharacterisedRecording>& recordings,
                                       const JobResults& results) {
  std::vector<SensorSources> sensors = sensors_of(recordings);
  for (SensorSources& sensor : sensors) {
    for (TableSource& source : sensor.sources) {
      const auto row = std::find_if(results.channels.begin(), results.channels.end(), [&](const ChannelResult& r) {
        return r.recording_id == source.recording_id && r.channel == source.channel.channel;
      });
      source.result_id = row == results.channels.end() ? "" : row->id;
    }
  }
  return sensors;
}

}  // namespace

Status add_own_summary(Json& document, const std::vector<CharacterisedRecording>& recordings, JobContext& context,
                       const RunControl& control, const JobResults& results) {
  const bool one_device = std::all_of(results.channels.begin(), results.channels.end(), [&](const ChannelResult& r) {
    return r.device_id == results.channels.front().device_id;
  });
  if (!one_device || results.channels.empty()) {
    document["trends"] = Json::array();
    document["replicates"] = Json::array();
    return {};
  }
  auto device = context.store.device(results.channels.front().device_id);
  if (!device) {
    return fail(device.error());
  }
  const auto summary = summarise_campaign(device->name, own_sensors(recordings, results), control);
  if (!summary) {
    return fail(summary.error());
  }
  add_summary(document, *summary);
  return {};
}

}  // namespace driftlab::server
