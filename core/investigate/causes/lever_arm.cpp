/// lever_arm: rotation about z at distance r: -r w^2 on x (radial), r dw/dt on y (tangential).
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& group, double /*shape*/,
           std::vector<std::vector<double>>& columns) {
  const Series& w = recording.rate[2];
  if (w.empty() || group.axis() > 1) {
    return false;
  }
  columns.assign(1, std::vector<double>(recording.length));
  for (std::size_t i = 0; i < recording.length; ++i) {
    columns[0][i] = group.axis() == 0 ? -w[i] * w[i] : recording.acceleration[2][i];
  }
  return true;
}

std::string lacks(const Study& /*study*/, const ChannelGroup& group) {
  const bool usable = group.role.quantity == Quantity::SpecificForce && group.axis() < 2 && !group.role.axis.empty() &&
                      turns_about(group, 2);
  return usable ? "" : "accelerometers x or y in rotation about z";
}

}  // namespace

Cause lever_arm() {
  return {.name = "lever_arm",
          .title = "accelerometers away from the axis of rotation",
          .equation = "y = −r ω² along the radius and y = r dω/dt along the tangent, ω the rate about z",
          .family = MeanEffect{.build = build, .penalty = 1.0, .one_for_all_axes = true},
          .rivals = {"turn_on_bias"},
          .needs = "accelerometers in rotation about z",
          .separates = "several rates: the error grows with their square",
          .parameters = {{"r", units::metres}},
          .lacks = lacks,
          .showing = {.scenario = Scenario::Turning}};
}

}  // namespace driftlab::investigate
