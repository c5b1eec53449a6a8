/// rate_dependent_noise: white noise that grows with the reference rate (driven_noise.hpp).
#include "core/investigate/causes/causes.hpp"
#include "core/investigate/causes/driven_noise.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

constexpr Driver kDriver = &StudyRecording::rate;

std::vector<Evidence> examine(const FullRate& data) { return examine_driven(data, kDriver, units::per_rate); }

void deviation(const FullRate& data, const Evidence& found, std::size_t r, std::vector<double>& sd) {
  driven_deviation(data, found, r, kDriver, sd);
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  inject_driven(draft, values[0], kDriver);
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
