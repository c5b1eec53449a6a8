/// bias_step: the mean jumps by `step` at t0, t0 from the first sample of the file, in one recording.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/process/random.hpp"

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& /*group*/, double t0_s,
           std::vector<std::vector<double>>& columns) {
  columns.assign(1, std::vector<double>(recording.length, 0.0));
  for (std::size_t i = 0; i < recording.length; ++i) {
    columns[0][i] = recording.time_s(i) >= t0_s - 1e-9 ? 1.0 : 0.0;
  }
  return true;
}

double shown_t0(const Stage& stage, Random& random) { return stage.duration_s * (0.2 + 0.6 * random.uniform()); }

}  // namespace

Cause bias_step() {
  return {.name = "bias_step",
          .title = "a jump of the bias",
          .equation = "y = 0 before t₀ and y = step from t₀ on",
          .family = MeanEffect{.build = build, .scope_all = false, .scope_single = true, .change_point = true},
          .rivals = {"random_walk", "gauss_markov", "linear_drift", "warm_up_transient", "temperature_bias",
                     "turn_on_bias"},
          .needs = "any recording",
          .separates = "more recordings of the same condition: a jump happens once, a random walk in every record",
          .parameters = {{"step", units::level}, {"t0_s", units::seconds}},
          .showing = {.acting = Acting::SecondAlone, .shape = shown_t0}};
}

}  // namespace driftlab::investigate
