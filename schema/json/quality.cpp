#include "schema/json/quality.hpp"

#include "schema/json/stored_member.hpp"

namespace driftlab {
namespace {

Json to_json(const ChannelQuality& channel) {
  return Json{{"column", channel.column},
              {"missing", channel.missing},
              {"implausible", channel.implausible},
              {"repeated", channel.repeated},
              {"distinct", channel.distinct ? Json(*channel.distinct) : Json(nullptr)},
              {"resolution", channel.resolution > 0.0 ? number(channel.resolution) : Json(nullptr)},
              {"saturated", channel.saturated},
              {"frozen", channel.frozen},
              {"frozen_from", channel.frozen > 0 ? Json(channel.frozen_from) : Json(nullptr)},
              {"first", channel.first},
              {"last", channel.last},
              {"analysed", channel.analysed}};
}

ChannelQuality channel_from_json(const Json& document) {
  ChannelQuality channel;
  channel.column = text_member(document, "column");
  channel.missing = count_member(document, "missing");
  channel.implausible = count_member(document, "implausible");
  channel.repeated = count_member(document, "repeated");
  if (const auto distinct = document.find("distinct"); distinct != document.end() && distinct->is_number_unsigned()) {
    channel.distinct = distinct->get<std::size_t>();
  }
  channel.resolution = finite_member(document, "resolution", 0.0);
  channel.saturated = count_member(document, "saturated");
  channel.frozen = count_member(document, "frozen");
  channel.frozen_from = count_member(document, "frozen_from");
  channel.first = count_member(document, "first");
  channel.last = count_member(document, "last");
  channel.analysed = count_member(document, "analysed");
  return channel;
}

}  // namespace

Json to_json(const Quality& quality) {
  Json document{{"samples", quality.samples},
                {"analysed", quality.analysed},
                {"gaps", quality.gaps},
                {"missing", quality.missing},
                {"repeated_stamps", quality.repeated_stamps},
                {"backward_steps", quality.backward_steps},
                {"counter_wraps", quality.counter_wraps},
                {"bursts", quality.bursts},
                {"longest_gap_s", number(quality.longest_gap_s)},
                {"jitter_s", number(quality.jitter_s)}};
  document["measured_rate_hz"] = quality.measured_rate_hz > 0.0 ? number(quality.measured_rate_hz) : Json(nullptr);
  document["clock_ratio"] = quality.clock_ratio ? number(*quality.clock_ratio) : Json(nullptr);
  if (quality.repeated_rows > 0) {
    document["repeated_rows"] = quality.repeated_rows;
  }
  document["channels"] = Json::array();
  for (const ChannelQuality& channel : quality.channels) {
    document["channels"].push_back(to_json(channel));
  }
  document["notes"] = quality.notes;
  return document;
}

Quality quality_from_json(const Json& document) {
  Quality quality;
  if (!document.is_object()) {
    return quality;
  }
  quality.samples = count_member(document, "samples");
  quality.repeated_rows = count_member(document, "repeated_rows");
  quality.analysed = count_member(document, "analysed");
  quality.missing = count_member(document, "missing");
  quality.gaps = count_member(document, "gaps");
  quality.repeated_stamps = count_member(document, "repeated_stamps");
  quality.backward_steps = count_member(document, "backward_steps");
  quality.counter_wraps = count_member(document, "counter_wraps");
  const auto bursts = document.find("bursts");
  quality.bursts = bursts != document.end() && bursts->is_boolean() && bursts->get<bool>();
  quality.longest_gap_s = finite_member(document, "longest_gap_s", 0.0);
  quality.jitter_s = finite_member(document, "jitter_s", 0.0);
  quality.measured_rate_hz = finite_member(document, "measured_rate_hz", 0.0);
  if (const auto ratio = document.find("clock_ratio"); ratio != document.end() && ratio->is_number()) {
    quality.clock_ratio = ratio->get<double>();
  }
  for (const Json& channel : document.value("channels", Json::array())) {
    quality.channels.push_back(channel_from_json(channel));
  }
  for (const Json& note : document.value("notes", Json::array())) {
    quality.notes.push_back(note.is_string() ? note.get<std::string>() : "");
  }
  return quality;
}

}  // namespace driftlab
