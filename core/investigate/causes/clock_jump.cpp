/// clock_jump: from t0 on measured follows w(t - delta) (core/investigate/consistency/reference_clock.hpp).
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/clock_faults.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

std::vector<FaultyRecordings> find(const Study& study, const std::stop_token& stop) {
  return clock_faults(study, ClockBreak::Jump, "delta_s", units::seconds({}), stop);
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  inject_clock_break(draft, ClockBreak::Jump, values);
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  return shown_clock_break(stage, ClockBreak::Jump);
}

}  // namespace

Cause clock_jump() {
  return {.name = "clock_jump",
          .title = "a clock that jumps",
          .equation = "x(t) = ω(t) before t₀ and x(t) = ω(t − δ) from t₀ on, x the reading and ω the reference",
          .family = RecordingFault{.find = find},
          .rivals = {"sampling_rate_change", "reference_time_offset", "reference_clock_drift"},
          .needs = "a motion profile with a reference column",
          .separates = "the same profile once more: a jump stays where it was only by chance",
          .parameters = {{"delta_s", units::seconds}, {"t0_s", units::seconds}},
          .lacks = lacks_profile,
          .inject = inject_effect,
          .showing = {
              .scenario = Scenario::Profile, .acting = Acting::SecondAlone, .values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
