#include "server/jobs/attention.hpp"

#include "schema/json/channel_summary.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

void note(const Json& summary, Attention about, JobResults& results) {
  if (!summary.is_object() || summary.value("level", "fine") == "fine") {
    return;
  }
  about.level = summary.at("level").get<std::string>();
  about.verdict = summary.at("verdict").get<std::string>();
  about.channel = summary.value("channel", "");
  results.attention.push_back(std::move(about));
}

/// The recording at `first` of the results, whose channels stand next to each other; returns the one behind it.
std::vector<ChannelResult>::const_iterator note_recording(std::vector<ChannelResult>::const_iterator first,
                                                          JobResults& results) {
  const auto end = std::find_if(first, results.channels.cend(), [&](const ChannelResult& channel) {
    return channel.recording_id != first->recording_id;
  });
  Json channels = Json::array();
  std::transform(first, end, std::back_inserter(channels), [](const ChannelResult& channel) {
    return parse_json(channel.document_json).value_or(Json(nullptr));
  });
  Attention about;
  about.device_id = first->device_id;
  about.recording_id = first->recording_id;
  results.looked_at.push_back(first->recording_id);
  note(gravest_summary(channels), std::move(about), results);
  return end;
}

}  // namespace

void note_attention(JobResults& results) {
  if (results.channels.empty()) {
    Attention about;
    about.device_id = results.investigations.empty() ? "" : results.investigations.front().device_id;
    const auto document = parse_json(results.document_json);
    const bool told = document && document->is_object() && document->contains("summary");
    note(told ? document->at("summary") : Json(nullptr), std::move(about), results);
  }
  for (auto channel = results.channels.cbegin(); channel != results.channels.cend();) {
    channel = note_recording(channel, results);
  }
}

}  // namespace driftlab::server
