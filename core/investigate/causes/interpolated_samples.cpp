/// interpolated_samples: recorded at a lower rate and interpolated linearly between those samples
/// (core/investigate/facts/resampled.hpp).
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/recordings.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/facts/resampled.hpp"
#include "core/investigate/study/lattice.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// What all examined channels of the recording agree on.
Thinning look(const StudyRecording& recording) {
  Thinning common;
  for (const Channel& channel : recording.channels) {
    if (channel.input_only || channel.error.empty() || recording.stamps.missing > 0) {
      continue;
    }
    const Interpolation found = find_interpolation(channel.rows, find_lattice(channel.rows).decimals);
    if (found.every == 0 || (common.every != 0 && common.every != found.every)) {
      return {};
    }
    common = {found.every, found.phase};
  }
  return common;
}

FoundParameter source_rate(const StudyRecording& recording, std::size_t every) {
  const double rate = 1.0 / recording.dt_s / static_cast<double>(every);
  return {"source_rate_hz", {rate, {rate * (1.0 - 1e-4), rate * (1.0 + 1e-4)}}, units::hertz({})};
}

std::vector<FaultyRecordings> find(const Study& study, const std::stop_token& stop) {
  return resampled_recordings(
      study, look, source_rate,
      "recorded at a lower rate and interpolated, for between samples every value lies on a straight line", stop);
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  const auto every = static_cast<std::size_t>(std::max(1.0, std::round(1.0 / (values[0] * draft.recording->dt_s))));
  for (double& v : draft.white) {  // white noise of the lower rate
    v /= std::sqrt(static_cast<double>(every));
  }
  draft.output.emplace_back([every](std::vector<double>& out) {
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::size_t from = i - i % every;
      const double share = static_cast<double>(i % every) / static_cast<double>(every);
      const double next = from + every < out.size() ? out[from + every] : out[from];
      out[i] = i == from ? out[i] : out[from] + share * (next - out[from]);
    }
  });
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) { return {0.5 * stage.rate_hz}; }

}  // namespace

Cause interpolated_samples() {
  return {
      .name = "interpolated_samples",
      .title = "samples interpolated between fewer",
      .equation =
          "z(t) = x(a) + (x(b) − x(a)) (t − a) / (b − a), a and b the neighbours of t among samples at the source rate",
      .family = RecordingFault{.find = find},
      .rivals = {},
      .needs = "any recording",
      .separates = "the same recording at the sensor's own output rate",
      .parameters = {{"source_rate_hz", units::hertz}},
      .inject = inject_effect,
      .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
