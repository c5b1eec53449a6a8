/// turned_sign: in some recordings the channel's sign is turned (core/investigate/consistency/recording_gains.hpp).
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/recordings.hpp"
#include "core/investigate/consistency/recording_gains.hpp"
#include "core/investigate/study/inputs.hpp"

#include <algorithm>

namespace driftlab::investigate {
namespace {

std::vector<FaultyRecordings> find(const Study& study, const std::stop_token& stop) {
  std::vector<DoubtfulRecording> turned = doubtful_recordings(study, stop);
  std::erase_if(turned, [](const DoubtfulRecording& d) { return d.doubt != RecordingDoubt::TurnedSign; });
  if (turned.empty()) {
    return {};
  }
  FaultyRecordings fault;
  for (const DoubtfulRecording& doubt : turned) {
    const StudyRecording& recording = study.recordings[doubt.recording];
    fault.channels.push_back(name_of(recording, recording.channels[doubt.channel]));
  }
  fault.sentence = list_of_names(fault.channels) + (fault.channels.size() > 1 ? " follow" : " follows") +
                   " the motion with the opposite sign (gain " + in_digits(turned.front().factor) +
                   "). What follows is of the values with their sign turned back.";
  fault.mend = [turned](Study& mended, std::deque<std::vector<double>>& /*rows*/) {
    for (const DoubtfulRecording& doubt : turned) {
      Channel& channel = mended.recordings[doubt.recording].channels[doubt.channel];
      turn_sign(channel);
      renew_error(channel);
    }
  };
  return {fault};
}

void inject_effect(Draft& draft, std::span<const double> /*values*/, Random& /*random*/) {
  draft.output.emplace_back([](std::vector<double>& out) {
    for (double& v : out) {
      v = -v;
    }
  });
}

std::vector<double> shown_values(const Stage& /*stage*/, Random& /*random*/) { return {}; }

}  // namespace

Cause turned_sign() {
  return {
      .name = "turned_sign",
      .title = "a channel whose sign is turned",
      .equation = "z = −x, x the reading in the stated direction",
      .family = RecordingFault{.find = find},
      .rivals = {"turn_on_bias", "scale_factor_error"},
      .needs = "motion that is known",
      .separates = "a turn of known sense",
      .parameters = {},
      .lacks = lacks_rotation,
      .inject = inject_effect,
      .showing = {.scenario = Scenario::Rates, .acting = Acting::SecondAlone, .values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
