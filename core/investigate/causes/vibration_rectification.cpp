/// vibration_rectification: a bias proportional to the variance of f along the same axis in a centred window of 1 s.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& group, double /*shape*/,
           std::vector<std::vector<double>>& columns) {
  const Series& force = recording.force[group.axis()];
  if (force.empty()) {
    return false;
  }
  columns.assign(1, running_variance(force, 1.0 / recording.dt_s));
  return true;
}

}  // namespace

Cause vibration_rectification() {
  return {.name = "vibration_rectification",
          .title = "a bias that vibration causes",
          .equation = "y = coefficient · var(f), f the specific force along the same axis in a centred window of 1 s",
          .family = MeanEffect{.build = build, .penalty = 1.0},
          .rivals = {"g_sensitivity", "turn_on_bias", "gauss_markov"},
          .needs = "an accelerometer along the gyro's axis, and vibration that comes and goes",
          .separates = "vibration of several strengths in one recording",
          .parameters = {{"coefficient", units::per_force_squared}},
          .lacks = lacks_force,
          .showing = {.scenario = Scenario::Shake}};
}

}  // namespace driftlab::investigate
