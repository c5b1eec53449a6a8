/// missing_samples: samples are absent and the time column jumps. Counted on the grid that fits the stamps.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

std::vector<Evidence> find(const ChannelGroup& group, const std::stop_token& /*stop*/) {
  Evidence evidence;
  double missing = 0.0;
  double places = 0.0;
  for (std::size_t r = 0; r < group.members.size(); ++r) {
    const StudyRecording& recording = *group.members[r].recording;
    if (recording.stamps.missing > 0) {
      evidence.members.push_back(r);
    }
    if (recording.stamps.present) {
      missing += static_cast<double>(recording.stamps.missing);
      places += static_cast<double>(recording.length);
    }
  }
  if (evidence.members.empty()) {
    return {};
  }
  const double fraction = missing / places;
  const double sd = std::sqrt(fraction * (1.0 - fraction) / places);
  evidence.gain = evidence.score = 1000.0 + missing;
  evidence.parameters = {
      {"fraction", {fraction, {std::max(0.0, fraction - 1.96 * sd), fraction + 1.96 * sd}}, units::one(group.unit)}};
  return {evidence};
}

void events(const Channel& channel, std::vector<unsigned char>& mask) {
  for (std::size_t i = 0; i < mask.size(); ++i) {
    mask[i] = channel.valid[i] == 0 ? 1 : 0;
  }
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  draft.present.resize(draft.white.size(), 1);
  for (std::size_t i = 1; i + 1 < draft.present.size(); ++i) {
    draft.present[i] = random.uniform() < values[0] ? 0 : 1;
  }
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) { return {0.002 * stage.z}; }

}  // namespace

Cause missing_samples() {
  return {.name = "missing_samples",
          .title = "samples that are absent",
          .equation = "t(k+1) − t(k) = (1 + m) Δt where m samples are absent; fraction: absent samples of all",
          .family = FileFact{.find = find, .events = events},
          .rivals = {},
          .needs = "a time column",
          .separates = "",
          .parameters = {{"fraction", units::one}},
          .lacks = lacks_stamps,
          .inject = inject_effect,
          .showing = {.values = shown_values}};
}

}  // namespace driftlab::investigate
