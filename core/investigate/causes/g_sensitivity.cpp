/// g_sensitivity: G f on a gyro channel, f the specific force along the same axis.
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
  columns.assign(1, force.values());
  return true;
}

}  // namespace

Cause g_sensitivity() {
  return {.name = "g_sensitivity",
          .title = "a gyro that feels specific force along its axis",
          .equation = "y = G f, f the specific force along the same axis",
          .family = MeanEffect{.build = build, .penalty = 1.0},
          .rivals = {"vibration_rectification", "turn_on_bias"},
          .needs = "an accelerometer along the gyro's axis, and a specific force that varies",
          .separates = "the six positions of the device, each at least twice",
          .parameters = {{"G", units::per_force}},
          .lacks = lacks_force,
          .showing = {.scenario = Scenario::SixPosition}};
}

}  // namespace driftlab::investigate
