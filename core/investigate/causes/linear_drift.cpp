/// linear_drift: the bias drifts, R t, t from the first sample of the file.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& /*group*/, double /*shape*/,
           std::vector<std::vector<double>>& columns) {
  columns.assign(1, std::vector<double>(recording.length));
  for (std::size_t i = 0; i < recording.length; ++i) {
    columns[0][i] = recording.time_s(i);
  }
  return true;
}

}  // namespace

Cause linear_drift() {
  return {
      .name = "linear_drift",
      .title = "a bias that drifts at a constant rate",
      .equation = "y = R t, t from the first sample of the file",
      .family =
          MeanEffect{
              .build = build, .penalty = 1.0, .scope_moving = true, .scope_single = true, .drift_of_baseline = true},
      .rivals = {"warm_up_transient", "random_walk", "gauss_markov", "temperature_bias", "bias_step"},
      .needs = "any recording",
      .separates = "a recording several times as long: a drift goes on, a warm-up ends, a random walk turns back",
      .parameters = {{"R", units::per_second}},
      .process = "linear_drift",
      .showing = {.acting = Acting::SecondAlone}};
}

}  // namespace driftlab::investigate
