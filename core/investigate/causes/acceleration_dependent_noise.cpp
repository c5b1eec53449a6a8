/// acceleration_dependent_noise: white noise that grows with the reference acceleration (driven_noise.hpp).
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/driven_noise.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

constexpr Driver kDriver = &StudyRecording::acceleration;

std::vector<Evidence> examine(const FullRate& data) { return examine_driven(data, kDriver, units::per_acceleration); }

void deviation(const FullRate& data, const Evidence& found, std::size_t r, std::vector<double>& sd) {
  driven_deviation(data, found, r, kDriver, sd);
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  inject_driven(draft, values[0], kDriver);
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) { return {shown_driven(stage, kDriver)}; }

}  // namespace

Cause acceleration_dependent_noise() {
  return {.name = "acceleration_dependent_noise",
          .title = "white noise that grows with the angular acceleration",
          .equation = "N(α) = N₀ (1 + k |α|), N² the density of the white noise, α the angular acceleration",
          .family = NoiseLevel{.examine = examine, .deviation = deviation},
          .rivals = {"white_noise_level", "rate_dependent_noise", "noise_level_change", "quantization_noise"},
          .needs = "several accelerations or a profile",
          .separates = "several accelerations through the same rates",
          .parameters = {{"k", units::per_acceleration}},
          .lacks = lacks_slopes,
          .inject = inject_effect,
          .showing = {.scenario = Scenario::Profile, .values = shown_values}};
}

}  // namespace driftlab::investigate
