/// averaged_samples: the driver returns the mean of each sample and those before it
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

constexpr std::size_t kMost = 500000;  ///< samples that are looked at

/// What all examined channels of the recording agree on.
Thinning look(const StudyRecording& recording) {
  Thinning common;
  for (const Channel& channel : recording.channels) {
    if (channel.input_only || channel.error.empty() || recording.stamps.missing > 0) {
      continue;
    }
    const Lattice lattice = find_lattice(channel.rows);
    const double step = std::max(lattice.step, lattice.decimals) * std::fabs(channel.unit.factor);
    const std::vector<double> part = channel.error.part(recording.begin, std::min(recording.count(), kMost)).values();
    const std::size_t every = find_running_mean(part, step);
    if (every == 0 || (common.every != 0 && common.every != every)) {
      return {};
    }
    common.every = every;
  }
  return common;
}

FoundParameter samples(const StudyRecording& /*recording*/, std::size_t every) {
  const auto m = static_cast<double>(every);
  return {"samples", {m, {m, m}}, units::one({})};
}

std::vector<FaultyRecordings> find(const Study& study, const std::stop_token& stop) {
  return resampled_recordings(
      study, look, samples,
      "every value is a mean over several samples, for the spectrum has the zeros and the shape of a running mean",
      stop);
}

/// A mean over samples from before the first is that of those there are.
void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  const auto many = static_cast<std::size_t>(std::max(1.0, std::round(values[0])));
  draft.output.emplace_back([many](std::vector<double>& out) {
    const std::vector<double> before = out;
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::size_t from = i + 1 > many ? i + 1 - many : 0;
      double sum = 0.0;
      for (std::size_t k = from; k <= i; ++k) {
        sum += before[k];
      }
      out[i] = sum / static_cast<double>(i + 1 - from);
    }
  });
}

std::vector<double> shown_values(const Stage& stage, Random& random) {
  return {stage.z > 20.0 ? 2.0 : 2.0 + static_cast<double>(random.below(3))};
}

}  // namespace

Cause averaged_samples() {
  return {.name = "averaged_samples",
          .title = "samples that are means over several",
          .equation = "z(k) = (x(k) + x(k−1) + … + x(k − samples + 1)) / samples, x the reading before the mean",
          .family = RecordingFault{.find = find},
          .rivals = {"band_limited_noise"},
          .needs = "any recording",
          .separates = "the same recording with the driver's averaging switched off",
          .parameters = {{"samples", units::one}},
          .inject = inject_effect,
          .showing = {.values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
