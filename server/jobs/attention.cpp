#include "server/jobs/attention.hpp"

#include "schema/json/stored_channel.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

void note(Attention about, JobResults& results) {
  if (!about.level.empty() && about.level != name_of(VerdictLevel::Fine)) {
    results.attention.push_back(std::move(about));
  }
}

/// The recording at `first` of the results, whose channels stand next to each other; returns the one behind it.
std::vector<ChannelResult>::const_iterator note_recording(std::vector<ChannelResult>::const_iterator first,
                                                          JobResults& results) {
  const auto end = std::find_if(first, results.channels.cend(), [&](const ChannelResult& channel) {
    return channel.recording_id != first->recording_id;
  });
  Json documents = Json::array();
  std::transform(first, end, std::back_inserter(documents), [](const ChannelResult& channel) {
    return parse_json(channel.document_json).value_or(Json(nullptr));
  });
  Attention about;
  about.device_id = first->device_id;
  about.recording_id = first->recording_id;
  results.looked_at.push_back(first->recording_id);
  if (const auto gravest = gravest_channel(stored_channels_from_json(documents))) {
    about.level = name_of(gravest->verdict.level);
    about.verdict = gravest->verdict.sentence;
    about.channel = gravest->channel;
  }
  note(std::move(about), results);
  return end;
}

}  // namespace

void note_attention(JobResults& results) {
  if (results.channels.empty()) {
    Attention about;
    about.device_id = results.investigations.empty() ? "" : results.investigations.front().device_id;
    const auto document = parse_json(results.document_json);
    const Json summary = document && document->is_object() ? document->value("summary", Json()) : Json();
    if (summary.is_object()) {
      about.level = summary.value("level", "");
      about.verdict = summary.value("verdict", "");
    }
    note(std::move(about), results);
  }
  for (auto channel = results.channels.cbegin(); channel != results.channels.cend();) {
    channel = note_recording(channel, results);
  }
}

}  // namespace driftlab::server
