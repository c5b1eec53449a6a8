/// unit_error: a recording is in another unit than the one declared (core/investigate/consistency/recording_gains.hpp).
/// The factor is that of its readings over what they would be in the declared unit.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/recordings.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/consistency/recording_gains.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace driftlab::investigate {
namespace {

/// The unit whose readings are `factor` times those in the declared one; its symbol is empty where it has no name.
Unit true_unit(const Unit& declared, double factor) {
  for (const Unit& unit : all_units()) {
    if (unit.dimension == declared.dimension && std::fabs(declared.factor / factor / unit.factor - 1.0) < 1e-3) {
      return unit;
    }
  }
  return {"", declared.dimension, declared.factor / factor, declared.offset};
}

void put_right(StudyRecording& recording, Channel& channel, double factor) {
  std::vector<double> right = channel.measured.values();
  for (double& v : right) {
    v /= factor;
  }
  channel.measured = std::move(right);
  channel.unit = true_unit(channel.unit, factor);
  renew_error(channel);
  const auto axis = axis_index(channel.role.axis);
  if (axis && channel.role.quantity == Quantity::SpecificForce) {
    recording.force[*axis] = channel.measured;
  }
}

FaultyRecordings describe(const Study& study, double factor, const std::vector<DoubtfulRecording>& doubts) {
  FaultyRecordings fault;
  for (const DoubtfulRecording& doubt : doubts) {
    const StudyRecording& recording = study.recordings[doubt.recording];
    fault.channels.push_back(name_of(recording, recording.channels[doubt.channel]));
  }
  const Unit& declared = study.recordings[doubts.front().recording].channels[doubts.front().channel].unit;
  const Unit unit = true_unit(declared, factor);
  fault.parameters = {{"factor", {factor, {factor * (1.0 - 1e-3), factor * (1.0 + 1e-3)}}, units::one({})}};
  fault.sentence = list_of_names(fault.channels) + (fault.channels.size() > 1 ? " are" : " is");
  fault.sentence.append(unit.symbol.empty() ? " " + in_digits(factor) + " times what it would be in " + declared.symbol
                                            : " in " + unit.symbol + ", not in " + declared.symbol + " as declared");
  fault.sentence.append(". What follows is of the right values.");
  fault.mend = [doubts, factor](Study& mended, std::deque<std::vector<double>>& /*rows*/) {
    for (const DoubtfulRecording& doubt : doubts) {
      StudyRecording& recording = mended.recordings[doubt.recording];
      put_right(recording, recording.channels[doubt.channel], factor);
    }
  };
  return fault;
}

std::vector<FaultyRecordings> find(const Study& study, const std::stop_token& stop) {
  std::map<double, std::vector<DoubtfulRecording>> by_factor;
  for (const DoubtfulRecording& doubt : doubtful_recordings(study, stop)) {
    if (doubt.doubt == RecordingDoubt::OtherUnit) {
      by_factor[doubt.factor].push_back(doubt);
    }
  }
  std::vector<FaultyRecordings> faults;
  for (const auto& [factor, doubts] : by_factor) {
    faults.push_back(describe(study, factor, doubts));
  }
  return faults;
}

void inject_effect(Draft& draft, std::span<const double> values, Random& /*random*/) {
  draft.output.emplace_back([factor = values[0]](std::vector<double>& out) {
    for (double& v : out) {
      v *= factor;
    }
  });
}

/// Readings in rad/s that are declared as deg/s.
std::vector<double> shown_values(const Stage& /*stage*/, Random& /*random*/) { return {kDegree}; }

}  // namespace

Cause unit_error() {
  return {
      .name = "unit_error",
      .title = "a recording in another unit than the one declared",
      .equation = "z = factor · x, x the reading in the unit declared",
      .family = RecordingFault{.find = find},
      .rivals = {"turn_on_bias", "scale_factor_error"},
      .needs = "motion that is known, or two recordings beside it",
      .separates = "the file's own documentation of its columns",
      .parameters = {{"factor", units::one}},
      .inject = inject_effect,
      .showing = {.scenario = Scenario::Rates, .acting = Acting::SecondAlone, .values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
