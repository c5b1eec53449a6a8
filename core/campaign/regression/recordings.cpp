#include "core/campaign/regression/recordings.hpp"

namespace driftlab::regression {

ChannelFacts facts_of(const Quality& quality, std::string_view column,
                      const std::optional<Contamination>& contamination) {
  ChannelFacts facts;
  facts.samples = quality.samples;
  if (const ChannelQuality* const known = quality.of(column); known != nullptr) {
    facts.missing = known->missing + known->implausible;
    facts.frozen = known->frozen;
    facts.repeated = known->repeated;
    facts.saturated = known->saturated;
    facts.resolution = known->resolution;
  }
  if (contamination) {
    facts.bursts = contamination->bursts.value_or(contamination->flagged_samples);
  }
  return facts;
}

void ComparedRecording::time_by_channels() {
  const ReportedChannel& first = channels.front().result;
  rate_hz = 1.0 / first.dt_s;
  duration_s = static_cast<double>(first.samples + first.missing) * first.dt_s;
}

void ComparedRecording::tell(const Quality& quality) {
  declared_hz = stated_rate_hz(quality.measured_rate_hz, quality.clock_ratio.value_or(0.0), rate_hz);
  jitter_s = quality.jitter_s;
  stamped = quality.measured_rate_hz > 0.0;
  samples = quality.samples;
  missing = quality.missing;
  notes = quality.notes;
}

}  // namespace driftlab::regression
