#include "schema/json/compared_recording.hpp"

#include "schema/json/recording_spec.hpp"
#include "schema/json/reported_channel.hpp"

#include <utility>

namespace driftlab {
namespace {

std::size_t compared_count(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::size_t>() : 0;
}

regression::ChannelFacts compared_facts(const Json& quality, const Json& channel) {
  regression::ChannelFacts facts;
  facts.samples = compared_count(quality, "samples");
  for (const Json& known : quality.value("channels", Json::array())) {
    if (text_member(known, "column") == text_member(channel, "channel")) {
      facts.missing = compared_count(known, "missing") + compared_count(known, "implausible");
      facts.frozen = compared_count(known, "frozen");
      facts.repeated = compared_count(known, "repeated");
      facts.saturated = compared_count(known, "saturated");
      facts.resolution = finite_member(known, "resolution", 0.0);
    }
  }
  if (const auto mean = channel.find("mean"); mean != channel.end() && mean->is_number()) {
    facts.mean = mean->get<double>();
  }
  facts.mean_of_error = channel.contains("reference");
  if (const auto found = channel.find("contamination"); found != channel.end() && found->is_object()) {
    // Where samples were not flagged one by one, and in results of before bursts were counted, each counts by itself.
    facts.bursts = compared_count(*found, found->contains("bursts") ? "bursts" : "flagged_samples");
  }
  return facts;
}

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
  return regression::ComparedChannel{std::move(*read), compared_facts(quality, channel)};
}

void tell_quality(const Json& quality, regression::ComparedRecording& recording) {
  recording.declared_hz = regression::stated_rate_hz(finite_member(quality, "measured_rate_hz", 0.0),
                                                     finite_member(quality, "clock_ratio", 0.0), recording.rate_hz);
  recording.jitter_s = finite_member(quality, "jitter_s", 0.0);
  recording.samples = compared_count(quality, "samples");
  recording.missing = compared_count(quality, "missing");
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
