/// heading_dependent_bias: A cos(heading - phi) over recordings at rest that state their heading: the horizontal part
/// of the Earth's rate on a gyroscope that lies level, or of gravity on an accelerometer whose table is not.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/signal/turns.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr double kTurnDeg = 360.0;

/// The shape is phi [deg].
bool build(const StudyRecording& recording, const ChannelGroup& /*group*/, double shape,
           std::vector<std::vector<double>>& columns) {
  if (!recording.condition.heading_deg) {
    return false;
  }
  const double angle = (*recording.condition.heading_deg - shape) / kTurnDeg * kTurn;
  columns.assign(1, std::vector<double>(recording.length, std::cos(angle)));
  return true;
}

/// Half a turn: what lies opposite is the negative.
std::vector<double> phases(const ChannelGroup& /*group*/) {
  std::vector<double> values;
  for (double phi = 0.0; phi < 0.5 * kTurnDeg; phi += 10.0) {
    values.push_back(phi);
  }
  return values;
}

/// Mean, sine and cosine need three headings, and one more recording to tell them from biases that merely differ.
std::string lacks(const Study& /*study*/, const ChannelGroup& group) {
  std::vector<double> headings;
  std::size_t stated = 0;
  for (const auto& member : group.members) {
    if (const auto heading = member.recording->condition.heading_deg) {
      ++stated;
      headings.push_back(*heading);
    }
  }
  std::sort(headings.begin(), headings.end());
  headings.erase(std::unique(headings.begin(), headings.end()), headings.end());
  return headings.size() >= 3 && stated >= 4 ? "" : "recordings at rest at three headings or more, four in all";
}

double shown_phase(const Stage& /*stage*/, Random& /*random*/) { return 40.0; }

}  // namespace

Cause heading_dependent_bias() {
  return {
      .name = "heading_dependent_bias",
      .title = "a bias that follows the heading",
      .equation = "y = amplitude · cos(heading − phase)",
      .family =
          MeanEffect{.build = build, .shapes = phases, .refinement = ShapeRefinement::phase(kTurnDeg), .penalty = 6.0},
      .rivals = {"turn_on_bias"},
      .needs = "recordings at rest whose conditions state their headings",
      .separates = "the same headings again, switched off in between: a bias that follows the heading comes back",
      .parameters = {{"amplitude", units::level}, {"phase_deg", units::degrees}},
      .lacks = lacks,
      .showing = {.scenario = Scenario::Headings, .shape = shown_phase}};
}

}  // namespace driftlab::investigate
