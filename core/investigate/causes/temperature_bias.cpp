/// temperature_bias: c (T_lag - mean), T_lag the temperature behind a first-order lag that starts settled at the first
/// sample.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/process/random.hpp"

#include <cmath>

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& /*group*/, double lag_s,
           std::vector<std::vector<double>>& columns) {
  if (recording.temperature.empty()) {
    return false;
  }
  columns.assign(1, std::vector<double>(recording.length));
  std::vector<double>& lagged = columns[0];
  const double follow = lag_s > 0.0 ? 1.0 - std::exp(-recording.dt_s / lag_s) : 1.0;
  double state = recording.temperature[0];
  for (std::size_t i = 0; i < recording.length; ++i) {
    state += follow * (recording.temperature[i] - state);
    lagged[i] = state;
  }
  double mean = 0.0;
  for (std::size_t i = recording.begin; i < recording.end; ++i) {
    mean += recording.temperature[i];
  }
  mean /= static_cast<double>(recording.count());
  for (double& value : lagged) {
    value -= mean;
  }
  return true;
}

std::vector<double> shapes(const ChannelGroup& /*group*/) {
  return {0.0, 4.0, 7.0, 12.0, 18.0, 27.0, 40.0, 60.0, 90.0, 140.0, 220.0};
}

std::string lacks(const Study& /*study*/, const ChannelGroup& group) {
  for (const auto& member : group.members) {
    if (!member.recording->temperature.empty()) {
      return "";
    }
  }
  return "a temperature column";
}

double shown_lag(const Stage& /*stage*/, Random& random) { return 20.0 + 40.0 * random.uniform(); }

}  // namespace

Cause temperature_bias() {
  return {.name = "temperature_bias",
          .title = "a bias that follows the temperature",
          .equation = "y = coefficient · (U − mean of T), lag · dU/dt = T − U, T the temperature",
          .family = MeanEffect{.build = build,
                               .shapes = shapes,
                               .refinement = ShapeRefinement::time(),
                               .penalty = 4.0,
                               .scope_single = true},
          .rivals = {"linear_drift", "warm_up_transient", "random_walk", "gauss_markov", "bias_step"},
          .needs = "a temperature column, and a temperature that changes",
          .separates = "a recording with another course of the temperature: up and down again, or held",
          .parameters = {{"coefficient", units::per_kelvin}, {"lag_s", units::seconds}},
          .lacks = lacks,
          .showing = {.scenario = Scenario::Temperature, .shape = shown_lag}};
}

}  // namespace driftlab::investigate
