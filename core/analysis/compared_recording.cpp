#include "core/analysis/compared_recording.hpp"

#include <cmath>

namespace driftlab {
namespace {

std::optional<double> where_finite(double value) { return std::isfinite(value) ? std::optional(value) : std::nullopt; }

/// The quality as its document has it, which knows neither infinity nor a step or rate below 0.
Quality documented(Quality quality) {
  const auto told = [](double value) { return value > 0.0 ? where_finite(value).value_or(0.0) : 0.0; };
  quality.measured_rate_hz = told(quality.measured_rate_hz);
  quality.clock_ratio = quality.clock_ratio ? where_finite(*quality.clock_ratio) : std::nullopt;
  quality.jitter_s = where_finite(quality.jitter_s).value_or(0.0);
  for (ChannelQuality& channel : quality.channels) {
    channel.resolution = told(channel.resolution);
  }
  return quality;
}

regression::ComparedChannel compared_channel(const CharacterisedChannel& channel, const Quality& quality) {
  regression::ChannelFacts facts = regression::facts_of(quality, channel.column, channel.result.contamination);
  const double factor = 1.0 / channel.role.unit.value_or(Unit{}).factor;
  facts.mean = where_finite(channel.result.mean * factor);
  facts.mean_of_error = channel.reference.has_value();
  return {reported(channel.column, channel.role, channel.result), facts};
}

}  // namespace

regression::ComparedRecording compared_recording(const CharacterisedRecording& recording) {
  const Quality quality = documented(recording.window.quality);
  regression::ComparedRecording compared;
  compared.id = recording.spec.id;
  compared.condition = to_text(without_heading(recording.spec.condition));
  compared.duration_s = where_finite(recording.window.duration_s()).value_or(0.0);
  compared.rate_hz = where_finite(recording.window.time.rate_hz()).value_or(0.0);
  compared.tell(quality);
  if (recording.temperature) {
    compared.temperature_degc = where_finite(recording.temperature->median_degc);
  }
  for (const CharacterisedChannel& channel : recording.channels) {
    compared.channels.push_back(compared_channel(channel, quality));
  }
  return compared;
}

}  // namespace driftlab
