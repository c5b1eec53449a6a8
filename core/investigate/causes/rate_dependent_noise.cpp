/// rate_dependent_noise: N(w) = N0 (1 + k abs(w)), w the reference rate about the channel's axis (for accelerometers:
/// about z). Innovations have variance c [1 + rho ((1 + k u)^2 - 1)].
#include "core/investigate/causes/causes.hpp"
#include "core/investigate/causes/inputs.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/draft.hpp"
#include "core/investigate/full_rate.hpp"
#include "core/investigate/modulation.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

std::vector<Evidence> examine(const FullRate& data) {
  const Modulation levels =
      modulation_of(data, [](const StudyRecording& recording, std::size_t axis) { return &recording.rate[axis]; });
  if (levels.distinct < 2) {
    return {};
  }
  const ModulationFit fit = fit_modulation(levels, data.given, 1.0 / levels.largest, [&](double u, double k) {
    const double factor = 1.0 + std::max(0.0, k) * u;
    return 1.0 + data.white_share * (factor * factor - 1.0);
  });
  if (fit.value <= 0.0) {
    return {};
  }
  const Interval interval = widened(fit, data);
  Evidence evidence;
  evidence.members = all_members(*data.group);
  evidence.gain = fit.gain;
  evidence.score = fit.gain / data.repeatability - 1.0;
  evidence.shape = fit.value;
  evidence.parameters = {
      {"k", {fit.value, {std::max(0.0, interval.low), interval.high}}, units::per_rate(data.group->unit)}};
  return {evidence};
}

void deviation(const FullRate& data, const Evidence& found, std::size_t r, std::vector<double>& sd) {
  const StudyRecording& recording = *data.group->members[r].recording;
  const std::size_t axis = data.group->role.quantity == Quantity::AngularRate ? data.group->axis() : 2;
  const std::vector<double>& u = recording.rate[axis];
  sd.assign(data.innovation[r].size(), 1.0);
  for (std::size_t i = 0; i < sd.size() && !u.empty(); ++i) {
    const double factor = 1.0 + found.shape * std::fabs(u[recording.begin + i]);
    sd[i] = std::sqrt(1.0 + data.white_share * (factor * factor - 1.0));
  }
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  const std::size_t axis = draft.group->role.quantity == Quantity::AngularRate ? draft.group->axis() : 2;
  const std::vector<double>& u = draft.recording->rate[axis];
  for (std::size_t i = 0; i < u.size(); ++i) {
    draft.white[i] *= 1.0 + values[0] * std::fabs(u[i]);
  }
}

}  // namespace

Cause rate_dependent_noise() {
  return {.name = "rate_dependent_noise",
          .title = "white noise that grows with the rate",
          .family = Family::Variance,
          .rivals = {"white_noise_level", "acceleration_dependent_noise", "noise_level_change", "quantization_noise"},
          .needs = "several rates or a profile",
          .separates = "more rates, at constant acceleration",
          .parameters = {{"k", units::per_rate}},
          .lacks = lacks_rates,
          .examine = examine,
          .deviation = deviation,
          .inject = inject_effect};
}

}  // namespace driftlab::investigate
