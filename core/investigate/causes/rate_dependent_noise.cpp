/// rate_dependent_noise: white noise that grows with the reference rate (driven_noise.hpp).
#include "core/investigate/causes/cause.hpp"
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

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) { return {shown_driven(stage, kDriver)}; }

}  // namespace

Cause rate_dependent_noise() {
  return {.name = "rate_dependent_noise",
          .title = "white noise that grows with the rate",
          .equation = "N(ω) = N₀ (1 + k |ω|), N² the density of the white noise, ω the rate",
          .family = NoiseLevel{.examine = examine, .deviation = deviation},
          .rivals = {"white_noise_level", "acceleration_dependent_noise", "noise_level_change", "quantization_noise"},
          .needs = "several rates or a profile",
          .separates = "more rates, at constant acceleration",
          .parameters = {{"k", units::per_rate}},
          .lacks = lacks_rates,
          .inject = inject_effect,
          .showing = {.scenario = Scenario::Rates, .values = shown_values}};
}

}  // namespace driftlab::investigate
