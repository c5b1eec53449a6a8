/// axis_misalignment: m w_other on an axis that should see none; the shape is the index of the other axis.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/unit_axis.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/investigate/study/reference_quality.hpp"

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& group, double other,
           std::vector<std::vector<double>>& columns) {
  const auto axis = static_cast<std::size_t>(other);
  if (group.role.quantity != Quantity::AngularRate || recording.rate[axis].empty()) {
    return false;
  }
  columns.assign(1, recording.rate[axis].values());
  return true;
}

std::vector<double> shapes(const ChannelGroup& group) {
  std::vector<double> others;
  for (std::size_t k = 0; k < 3; ++k) {
    if (k != group.axis() && turns_about(group, k)) {
      others.push_back(static_cast<double>(k));
    }
  }
  return others;
}

std::string lacks(const Study& /*study*/, const ChannelGroup& group) {
  if (group.role.quantity != Quantity::AngularRate || group.role.axis.empty() || shapes(group).empty()) {
    return "a gyroscope axis beside the axis of rotation";
  }
  return reference_lacks(group);
}

/// Of gyroscopes; the shape is the index of the other axis.
bool in_unit(const Evidence& found, UnitAxis& axis) {
  if (axis.channel > 2) {
    return false;
  }
  axis.misalignment.at(static_cast<std::size_t>(found.shape)) = found.parameters[0].estimate.value;
  return true;
}

double shown_other_axis(const Stage& /*stage*/, Random& /*random*/) { return 2.0; }

}  // namespace

Cause axis_misalignment() {
  return {.name = "axis_misalignment",
          .title = "a part of the rate about another axis (misalignment)",
          .equation = "y = m ω, ω the rate about another axis",
          .family = MeanEffect{.build = build, .shapes = shapes, .penalty = 1.0, .part_of_rate = true},
          .rivals = {"turn_on_bias"},
          .needs = "several axes in motion",
          .separates = "rates of both signs about the other axis",
          .parameters = {{"m", units::radians}},
          .lacks = lacks,
          .in_unit = in_unit,
          .showing = {.scenario = Scenario::TwoAxes, .axis = "x", .shape = shown_other_axis}};
}

}  // namespace driftlab::investigate
