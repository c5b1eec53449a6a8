/// saturation: the output is clipped at +-limit: at least eight values at one extreme while the reference comes near
/// it.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/investigate/study/lattice.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

std::vector<Evidence> find(const ChannelGroup& group, const std::stop_token& stop) {
  Evidence evidence;
  double limit = 0.0;
  double decimals = 0.0;
  for (std::size_t r = 0; r < group.members.size() && !stop.stop_requested(); ++r) {
    const Channel& channel = *group.members[r].channel;
    const double value = clipped_at(channel);
    if (!(value > 0.0)) {
      continue;
    }
    const double si = std::fabs(channel.unit.to_si(value) - channel.unit.to_si(0.0));
    evidence.members.push_back(r);
    evidence.score += static_cast<double>(
        std::count_if(channel.rows.begin(), channel.rows.end(), [&](double v) { return at_limit(v, value); }));
    limit = std::max(limit, si);
    decimals = std::max(decimals, find_lattice(channel.rows, stop).decimals * channel.unit.factor);
  }
  if (evidence.members.empty()) {
    return {};
  }
  evidence.score += 1000.0;
  evidence.gain = evidence.score;
  evidence.shape = limit;
  evidence.parameters = {
      {"limit", {limit, {limit - decimals - 1e-6 * limit, limit + decimals + 1e-6 * limit}}, units::level(group.unit)}};
  return {evidence};
}

/// Near the limit only the lower half of the noise is seen: everything whose reference comes within six deviations
/// goes.
void spoils(const ChannelGroup& group, const Evidence& found, std::size_t r, std::vector<unsigned char>& mask) {
  const Channel& channel = *group.members[r].channel;
  const double margin = 6.0 * noise_of_differences(*group.members[r].recording, channel);
  for (std::size_t i = 0; i < channel.reference.size(); ++i) {
    if (std::fabs(channel.reference[i]) > found.shape - margin ||
        std::fabs(channel.measured[i]) > found.shape - margin) {
      mask[i] = 1;
    }
  }
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  const double limit = values[0];
  draft.output.emplace_back([limit](std::vector<double>& out) {
    for (double& v : out) {
      v = std::clamp(v, -limit, limit);
    }
  });
}

bool in_unit(const Evidence& found, UnitAxis& axis) {
  axis.range = found.parameters[0].estimate.value;
  return true;
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  double top = 0.0;
  for (const StudyRecording& recording : stage.study.recordings) {
    for (const double w : recording.rate[2]) {
      top = std::max(top, std::fabs(w));
    }
  }
  return {top * (1.0 - 0.005 * stage.z)};
}

}  // namespace

Cause saturation() {
  return {.name = "saturation",
          .title = "an output that is clipped",
          .equation = "z = max(−limit, min(limit, x)), x the reading before it is clipped",
          .family = FileFact{.find = find, .spoils = spoils},
          .rivals = {},
          .needs = "motion beyond the range, with a reference",
          .separates = "",
          .parameters = {{"limit", units::level}},
          .lacks = lacks_rates,
          .inject = inject_effect,
          .in_unit = in_unit,
          .showing = {.scenario = Scenario::Profile, .values = shown_values}};
}

}  // namespace driftlab::investigate
