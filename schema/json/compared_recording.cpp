#include "schema/json/compared_recording.hpp"

#include "schema/json/quality.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/reported_channel.hpp"
#include "schema/json/stored_member.hpp"

#include <utility>

namespace driftlab {
namespace {

regression::ComparedRecording compared_recording(const Json& document) {
  regression::ComparedRecording recording;
  Faults ignored;
  recording.id = document.at("id").get<std::string>();
  recording.condition = to_text(without_heading(condition_from_json(document.at("condition"), "", ignored)));
  recording.duration_s = finite_member(document, "duration_s", 0.0);
  recording.rate_hz = finite_member(document, "rate_hz", 0.0);
  const Json quality = document.value("quality", Json::object());
  tell_quality(quality, recording);
  for (const Json& channel : document.at("channels")) {
    if (auto read = compared_channel_from_json(channel, quality)) {
      recording.channels.push_back(std::move(*read));
    }
  }
  return recording;
}

}  // namespace

Result<regression::ComparedChannel> compared_channel_from_json(const Json& channel, const Json& quality) {
  auto read = reported_channel_from_json(channel);
  if (!read) {
    return fail(read.error());
  }
  const auto found = contamination_from_json(channel);
  regression::ChannelFacts facts =
      regression::facts_of(quality_from_json(quality), text_member(channel, "channel"), found);
  if (const auto mean = channel.find("mean"); mean != channel.end() && mean->is_number()) {
    facts.mean = mean->get<double>();
  }
  facts.mean_of_error = channel.contains("reference");
  return regression::ComparedChannel{std::move(*read), facts};
}

void tell_quality(const Json& quality, regression::ComparedRecording& recording) {
  recording.tell(quality_from_json(quality));
  if (const auto temperature = quality.find("temperature"); temperature != quality.end() && temperature->is_object()) {
    const auto median = temperature->find("median_degc");
    if (median != temperature->end() && median->is_number()) {
      recording.temperature_degc = median->get<double>();
    }
  }
}

Result<regression::ComparedRecording> compared_recording_from_json(const Json& document) {
  try {
    return compared_recording(document);
  } catch (const Json::exception& fault) {
    return fail(ErrorCode::Internal, "A characterisation cannot be read: " + std::string(fault.what()) + ".");
  }
}

}  // namespace driftlab
