/// output_resolution: the output is rounded to multiples of a step that is coarse enough to show against the noise.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/lattice.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr double kNoticed = 0.1;   ///< step over noise from which it is reported
constexpr double kStriking = 0.2;  ///< below this it is ranked last

std::vector<Evidence> find(const ChannelGroup& group, const std::stop_token& stop) {
  Evidence evidence;
  // The recording that tells the step best. The others add nothing: the same multiples are written the same way in all.
  double step = 0.0;
  double sd = 0.0;
  double coarseness = 0.0;
  for (std::size_t r = 0; r < group.members.size() && !stop.stop_requested(); ++r) {
    const Channel& channel = *group.members[r].channel;
    const Lattice lattice = find_lattice(channel.rows, stop);
    const double si = lattice.step * channel.unit.factor;
    const double seen = noise_of_differences(*group.members[r].recording, channel);
    const double noise = noise_behind_lattice(seen, si);
    if (!(lattice.step > 0.0) || si < kNoticed * noise) {
      continue;
    }
    const double own_sd = std::max(lattice.step_sd, 1e-7 * lattice.step) * std::fabs(channel.unit.factor);
    if (evidence.members.empty() || own_sd < sd) {
      step = si;
      sd = own_sd;
    }
    evidence.members.push_back(r);
    coarseness = std::max(coarseness, si / noise);
  }
  if (evidence.members.empty()) {
    return {};
  }
  evidence.score = coarseness < kStriking ? 12.0 : 1000.0 * coarseness;
  evidence.gain = evidence.score;
  evidence.shape = coarseness;
  evidence.parameters = {{"step", {step, {step - 2.0 * sd, step + 2.0 * sd}}, units::level(group.unit)}};
  return {evidence};
}

/// Every value of one half that lies on the lattice of the other tells its place among all decimals; one beside it
/// costs as much.
double log_gain(const Channel& channel) {
  const auto middle = channel.rows.size() / 2;
  const std::span<const double> parts[2] = {channel.rows.first(middle), channel.rows.subspan(middle)};
  double gain = 0.0;
  for (std::size_t half = 0; half < 2; ++half) {
    const Lattice lattice = find_lattice(parts[half]);
    if (!(lattice.step > 0.0) || !(lattice.decimals > 0.0)) {
      continue;
    }
    const double worth = std::log(std::max(1.0, lattice.step / lattice.decimals));
    for (const double v : parts[1 - half]) {
      const double q = v / lattice.step;
      const bool on = std::fabs(q - std::round(q)) * lattice.step < 1.6 * lattice.decimals + 0.02 * lattice.step;
      gain += on ? worth : -worth;
    }
  }
  return gain;
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  const double step = values[0];
  draft.output.emplace_back([step](std::vector<double>& out) {
    for (double& v : out) {
      v = step * std::round(v / step);
    }
  });
}

bool in_unit(const Evidence& found, UnitAxis& axis) {
  axis.quantization_step = found.parameters[0].estimate.value;
  return true;
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  return {stage.white_sd() * (0.4 + 0.02 * stage.z)};
}

}  // namespace

Cause output_resolution() {
  return {.name = "output_resolution",
          .title = "a coarse output resolution",
          .equation = "z = step · round(x / step), x the reading before it is rounded",
          .family = FileFact{.find = find, .log_gain = log_gain, .gives_lattice_step = true},
          .rivals = {},
          .needs = "any recording",
          .separates = "",
          .parameters = {{"step", units::level}},
          .inject = inject_effect,
          .in_unit = in_unit,
          .showing = {.values = shown_values}};
}

}  // namespace driftlab::investigate
