/// sampling_rate_change: from t0 on measured follows w(t0 + (t - t0)(1 + eps))
/// (core/investigate/consistency/reference_clock.hpp).
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/clock_faults.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

std::vector<FaultyRecordings> find(const Study& study, const std::stop_token& stop) {
  return clock_faults(study, ClockBreak::RateChange, "eps", units::ppm({}), stop);
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  inject_clock_break(draft, ClockBreak::RateChange, values);
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  return shown_clock_break(stage, ClockBreak::RateChange);
}

}  // namespace

Cause sampling_rate_change() {
  return {.name = "sampling_rate_change",
          .title = "a sampling rate that changes",
          .equation = "x(t) = ω(t₀ + (t − t₀)(1 + ε)) from t₀ on, x the reading and ω the reference",
          .family = RecordingFault{.find = find},
          .rivals = {"clock_jump", "reference_clock_drift"},
          .needs = "a motion profile with a reference column",
          .separates = "a longer profile: the shift against the reference goes on growing",
          .parameters = {{"eps", units::ppm}, {"t0_s", units::seconds}},
          .lacks = lacks_profile,
          .inject = inject_effect,
          .showing = {
              .scenario = Scenario::Profile, .acting = Acting::SecondAlone, .values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
