/// linear_drift: the bias drifts, R t, t from the first sample of the file.
#include "core/investigate/causes/causes.hpp"
#include "core/investigate/causes/unit_axis.hpp"
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

constexpr MeanEffect kEffect{.build = build, .penalty = 1.0, .scope_moving = true, .scope_single = true};

bool in_unit(const Evidence& found, UnitAxis& axis) { return add_process(axis, "linear_drift", found); }

}  // namespace

Cause linear_drift() {
  return {.name = "linear_drift",
          .title = "a bias that drifts at a constant rate",
          .family = Family::Mean,
          .rivals = {"warm_up_transient", "random_walk", "gauss_markov", "temperature_bias", "bias_step"},
          .needs = "any recording",
          .separates = "a recording several times as long: a drift goes on, a warm-up ends, a random walk turns back",
          .parameters = {{"R", units::per_second}},
          .mean = &kEffect,
          .in_unit = in_unit};
}

}  // namespace driftlab::investigate
