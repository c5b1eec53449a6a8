/// swapped_axes: two channels of a recording are exchanged: one does not see its own axis, and another sees it
/// (core/investigate/consistency/recording_gains.hpp).
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/recordings.hpp"
#include "core/investigate/consistency/recording_gains.hpp"
#include "core/investigate/study/inputs.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab::investigate {
namespace {

void put_right(StudyRecording& recording, const DoubtfulRecording& doubt) {
  Channel& own = recording.channels[doubt.channel];
  Channel& other = recording.channels[doubt.other];
  std::swap(own.rows, other.rows);
  std::swap(own.unit, other.unit);
  std::swap(own.measured, other.measured);
  std::swap(own.valid, other.valid);
  if (doubt.turned) {
    turn_sign(own);
  }
  renew_error(own);
  renew_error(other);
}

std::vector<FaultyRecordings> find(const Study& study, const std::stop_token& stop) {
  std::vector<DoubtfulRecording> exchanged = doubtful_recordings(study, stop);
  std::erase_if(exchanged, [](const DoubtfulRecording& d) { return d.doubt != RecordingDoubt::SwappedAxes; });
  if (exchanged.empty()) {
    return {};
  }
  FaultyRecordings fault;
  std::vector<std::string> pairs;
  for (const DoubtfulRecording& doubt : exchanged) {
    const StudyRecording& recording = study.recordings[doubt.recording];
    const Channel& own = recording.channels[doubt.channel];
    const Channel& other = recording.channels[doubt.other];
    fault.channels.push_back(name_of(recording, own));
    fault.channels.push_back(name_of(recording, other));
    pairs.push_back(own.column + " and " + other.column + " of " + recording.id +
                    (doubt.turned ? " (and the sign of one turned)" : ""));
  }
  fault.sentence = list_of_names(pairs) + " are exchanged: the motion about one axis is seen by the other. " +
                   "What follows is of the channels put back.";
  fault.mend = [exchanged](Study& mended, std::deque<std::vector<double>>& /*rows*/) {
    for (const DoubtfulRecording& doubt : exchanged) {
      put_right(mended.recordings[doubt.recording], doubt);
    }
  };
  return {fault};
}

/// The axis that turns most is exchanged with the first other one; each then shows the motion of the other.
void inject_effect(Draft& draft, std::span<const double> /*values*/, Random& /*random*/) {
  const StudyRecording& recording = *draft.recording;
  std::size_t main = 0;
  double most = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0.0;
    for (const double w : recording.rate[k]) {
      sum += std::fabs(w);
    }
    main = sum > most ? k : main;
    most = std::max(most, sum);
  }
  const auto partner = std::find_if(recording.channels.begin(), recording.channels.end(), [&](const Channel& channel) {
    return channel.role.quantity == Quantity::AngularRate && axis_index(channel.role.axis) != main;
  });
  const std::size_t own = draft.group->axis();
  if (partner == recording.channels.end() || recording.rate[main].empty()) {
    return;
  }
  const std::optional<std::size_t> other = axis_index(partner->role.axis);
  if (!other || (own != main && own != *other)) {
    return;
  }
  const std::size_t second = *other;
  const Series& seen = recording.rate[own == main ? second : main];
  for (std::size_t i = 0; i < draft.mean.size(); ++i) {
    draft.mean[i] += (seen.empty() ? 0.0 : seen[i]) - (recording.rate[own].empty() ? 0.0 : recording.rate[own][i]);
  }
}

std::vector<double> shown_values(const Stage& /*stage*/, Random& /*random*/) { return {}; }

std::string lacks(const Study& study, const ChannelGroup& group) {
  const std::string axes = lacks_axes(study, group);
  return axes.empty() ? lacks_rates(study, group) : axes;
}

}  // namespace

Cause swapped_axes() {
  return {.name = "swapped_axes",
          .title = "two channels that are exchanged",
          .equation = "z₁ = x₂ and z₂ = x₁, x the readings of two axes in the stated order",
          .family = RecordingFault{.find = find},
          .rivals = {"axis_misalignment", "scale_factor_error", "turn_on_bias"},
          .needs = "several axes recorded together in motion that is known",
          .separates = "a turn about each axis by itself",
          .parameters = {},
          .lacks = lacks,
          .inject = inject_effect,
          .showing = {
              .scenario = Scenario::TwoAxes, .acting = Acting::SecondAlone, .values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
