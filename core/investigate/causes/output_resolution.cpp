/// output_resolution: the output is rounded to multiples of a step that is coarse enough to show against the noise.
#include "core/investigate/causes/causes.hpp"
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

std::vector<Evidence> file_fact(const ChannelGroup& group) {
  Evidence evidence;
  double weight = 0.0;
  double step = 0.0;
  double coarseness = 0.0;
  for (std::size_t r = 0; r < group.members.size(); ++r) {
    const Channel& channel = *group.members[r].channel;
    const Lattice lattice = find_lattice(channel.rows);
    const double si = lattice.step * channel.unit.factor;
    const double seen = noise_of_differences(*group.members[r].recording, channel);
    const double noise = std::sqrt(std::max(seen * seen - si * si / 12.0, 1e-4 * si * si));
    if (!(lattice.step > 0.0) || si < kNoticed * noise) {
      continue;
    }
    const double sd = std::max(lattice.step_sd, 1e-7 * lattice.step) * channel.unit.factor;
    evidence.members.push_back(r);
    weight += 1.0 / (sd * sd);
    step += si / (sd * sd);
    coarseness = std::max(coarseness, si / noise);
  }
  if (evidence.members.empty()) {
    return {};
  }
  step /= weight;
  const double sd = std::max(1.0 / std::sqrt(weight), 1e-7 * step);
  evidence.score = coarseness < kStriking ? 12.0 : 1000.0 * coarseness;
  evidence.gain = evidence.score;
  evidence.shape = coarseness;
  evidence.parameters = {{"step", {step, {step - 2.0 * sd, step + 2.0 * sd}}, units::level(group.unit)}};
  return {evidence};
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

}  // namespace

Cause output_resolution() {
  return {.name = "output_resolution",
          .title = "a coarse output resolution",
          .family = Family::File,
          .rivals = {},
          .needs = "any recording",
          .separates = "",
          .parameters = {{"step", units::level}},
          .file_fact = file_fact,
          .inject = inject_effect,
          .in_unit = in_unit};
}

}  // namespace driftlab::investigate
