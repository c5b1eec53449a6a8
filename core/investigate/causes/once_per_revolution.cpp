/// once_per_revolution: A sin(theta + phi), theta the integral of the rate from the first sample of the file; phi is
/// free in each recording, for the turntable starts anywhere.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"
#include "core/investigate/study/reference_quality.hpp"

#include <cmath>

namespace driftlab::investigate {
namespace {

bool build(const StudyRecording& recording, const ChannelGroup& /*group*/, double /*shape*/,
           std::vector<std::vector<double>>& columns) {
  if (recording.angle.empty()) {
    return false;
  }
  columns.assign(2, std::vector<double>(recording.length));
  for (std::size_t i = 0; i < recording.length; ++i) {
    columns[0][i] = std::sin(recording.angle[i]);
    columns[1][i] = std::cos(recording.angle[i]);
  }
  return true;
}

std::string lacks(const Study& /*study*/, const ChannelGroup& group) {
  if (stamps_are_loose(group)) {
    return std::string(kTightStamps);
  }
  for (const auto& member : group.members) {
    if (!member.recording->angle.empty()) {
      return "";
    }
  }
  return "a rotation";
}

}  // namespace

Cause once_per_revolution() {
  return {
      .name = "once_per_revolution",
      .title = "an error that repeats with every revolution",
      .equation = "y = amplitude · sin(θ + φ), θ = ∫ ω dt from the first sample of the file, φ free in each recording",
      .family = MeanEffect{.build = build, .columns = 2, .free_phase = true, .penalty = 2.0},
      .rivals = {"periodic_disturbance", "gauss_markov"},
      .needs = "rotation through several revolutions",
      .separates = "another rate: the error keeps its angle, a disturbance its frequency",
      .parameters = {{"amplitude", units::level}},
      .lacks = lacks,
      .showing = {.scenario = Scenario::Rates}};
}

}  // namespace driftlab::investigate
