/// white_noise_level: white noise of another density than the baseline's, in all recordings or in some.
/// Innovations in the scope have variance c [1 + rho (R^2 - 1)], R the ratio of densities and rho the share of the
/// white part.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/fullrate/modulation.hpp"
#include "core/investigate/study/inputs.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

std::vector<Evidence> examine(const FullRate& data) {
  std::vector<Evidence> found;
  const auto scopes = noise_scopes(*data.group, data.given);
  for (const auto& scope : scopes) {
    const Modulation levels = modulation_of_scope(data, scope);
    const ModulationFit fit = fit_modulation(levels, data.given, 1.0, [&](double u, double x) {
      return 1.0 + data.white_share * (std::exp(2.0 * x) - 1.0) * u;
    });
    Evidence evidence;
    evidence.members = scope;
    evidence.gain = fit.gain;
    evidence.score = fit.gain / data.repeatability - 1.0 - choice_penalty(static_cast<double>(scopes.size()));
    const Interval interval = widened(fit, data);
    const double n0 = std::sqrt(data.model.white * fit.scale);
    evidence.shape = fit.value;
    evidence.parameters = {{"N",
                            {n0 * std::exp(fit.value), {n0 * std::exp(interval.low), n0 * std::exp(interval.high)}},
                            units::density(data.group->unit)}};
    found.push_back(std::move(evidence));
  }
  return found;
}

void deviation(const FullRate& data, const Evidence& found, std::size_t r, std::vector<double>& sd) {
  const bool inside = std::find(found.members.begin(), found.members.end(), r) != found.members.end();
  const double ratio = 1.0 + data.white_share * (std::exp(2.0 * found.shape) - 1.0);
  sd.assign(data.innovation[r].size(), inside ? std::sqrt(ratio) : 1.0);
}

/// The new density stands in the place of the old one, which the draft's white part shows.
void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  const double sd = values[0] / std::sqrt(draft.recording->dt_s);
  for (double& v : draft.white) {
    v = sd * random.normal();
  }
}

/// The level found stands in the place of the old one.
bool in_unit(const Evidence& found, UnitAxis& axis) {
  std::erase_if(axis.model, [](const Process& process) { return process.kind->name == "white_noise"; });
  return add_process(axis, "white_noise", found);
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  const double own = stage.given ? 0.0 : 0.5 / stage.samples_each();
  return {stage.density * (1.0 + stage.z * std::sqrt(0.5 / (stage.samples_each() * (stage.recordings() - 1.0)) + own))};
}

}  // namespace

Cause white_noise_level() {
  return {
      .name = "white_noise_level",
      .title = "white noise of another level than the baseline's",
      .equation = "y = N w(t) in place of the baseline's white noise, w white noise of unit density",
      .family = NoiseLevel{.examine = examine, .deviation = deviation, .replaces_white = true},
      .rivals = {"rate_dependent_noise", "acceleration_dependent_noise", "noise_level_change", "quantization_noise"},
      .needs = "any recording; with an automatic baseline recordings of several conditions",
      .separates = "a profile through many rates",
      .parameters = {{"N", units::density}},
      .process = "white_noise",
      .lacks = lacks_contrast,
      .inject = inject_effect,
      .in_unit = in_unit,
      .showing = {.scenario = Scenario::Rates, .acting = Acting::AllButFirst, .values = shown_values}};
}

}  // namespace driftlab::investigate
