/// reference_noise: the reference column itself is noisy or coarse (core/investigate/consistency/noisy_reference.hpp).
/// N is the density of its noise above the motion; where its values lie on a lattice, the step of that is reported.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/recordings.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/consistency/noisy_reference.hpp"
#include "core/process/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// References of one kind, noisy or coarse, as one fault.
FaultyRecordings describe(const Study& study, const std::vector<NoisyReference>& noisy) {
  FaultyRecordings fault;
  std::vector<std::string> recordings;
  double weighted = 0.0;
  double weights = 0.0;
  double step = 0.0;
  double share = 0.0;
  for (const NoisyReference& one : noisy) {
    const StudyRecording& recording = study.recordings[one.recording];
    fault.channels.push_back(name_of(recording, recording.channels[one.channel]));
    recordings.push_back(recording.id);
    const double half = one.density.ci95.high - one.density.value;
    weighted += one.density.value / (half * half);
    weights += 1.0 / (half * half);
    step = std::max(step, one.step);
    share = std::max(share, one.share);
  }
  const Unit& unit = study.recordings[noisy.front().recording].channels[noisy.front().channel].unit;
  const LabUnit density = units::density(unit);
  const LabUnit level = units::level(unit);
  const double n = weighted / weights;
  const double half = 1.0 / std::sqrt(weights);
  recordings.erase(std::unique(recordings.begin(), recordings.end()), recordings.end());
  fault.sentence = "The reference of " + list_of_names(recordings);
  if (step > 0.0) {
    fault.parameters = {{"step", {step, {0.999 * step, 1.001 * step}}, level}};
    fault.sentence += " is coarse: its values are multiples of " + in_digits(step * level.per_si) + " " + level.symbol;
  } else {
    fault.parameters = {{"N", {n, {std::max(0.0, n - half), n + half}}, density}};
    fault.sentence += " is noisy: above " + in_digits(noisy.front().cut_hz) +
                      " Hz it tells no motion and shows white noise of " + in_digits(n * density.per_si) + " " +
                      density.symbol;
  }
  fault.sentence += ", which makes up to " + in_digits(std::round(100.0 * share)) + " % of the error's power there. ";
  fault.sentence += step > 0.0 ? "The noise of single samples is not examined beside it."
                               : "What follows allows for it: it is none of the sensor's.";
  fault.mend = [noisy](Study& mended, std::deque<std::vector<double>>& /*rows*/) {
    for (const NoisyReference& one : noisy) {
      mended.recordings[one.recording].reference_noise.at(one.axis) = {one.share / std::max(0.01, 1.0 - one.share),
                                                                       one.step > 0.0};
    }
  };
  return fault;
}

std::vector<FaultyRecordings> find(const Study& study, const std::stop_token& stop) {
  std::array<std::vector<NoisyReference>, 2> kinds;  // noisy, coarse
  for (const NoisyReference& one : noisy_references(study, stop)) {
    kinds.at(one.step > 0.0 ? 1 : 0).push_back(one);
  }
  std::vector<FaultyRecordings> faults;
  for (const std::vector<NoisyReference>& kind : kinds) {
    if (!kind.empty()) {
      faults.push_back(describe(study, kind));
    }
  }
  return faults;
}

std::string lacks(const Study& study, const ChannelGroup& /*group*/) {
  for (const StudyRecording& recording : study.recordings) {
    for (const Channel& channel : recording.channels) {
      if (channel.role.quantity == Quantity::AngularRate && !channel.reference.empty() && !recording.condition.value &&
          !recording.is_static()) {
        return "";
      }
    }
  }
  return "a reference column";
}

/// White noise in the column that tells the motion; the sensor's readings stay.
void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  const double sd = values[0] / std::sqrt(draft.recording->dt_s);
  draft.reference.resize(draft.recording->length, 0.0);
  for (double& v : draft.reference) {
    v += sd * random.normal();
  }
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) {
  return {stage.density * std::sqrt(0.02 + 1.5 * stage.z / std::sqrt(stage.samples_each()))};
}

}  // namespace

Cause reference_noise() {
  return {.name = "reference_noise",
          .title = "a reference that is noisy or coarse itself",
          .equation =
              "r = ω + N w(t), w white noise of unit density, or r = step · round(ω / step), r the reference column",
          .family = RecordingFault{.find = find},
          .rivals = {"rate_dependent_noise", "white_noise_level", "scale_factor_error"},
          .needs = "a reference column",
          .separates = "another reference, or the same one at rest",
          .parameters = {{"N", units::density}},
          .lacks = lacks,
          .inject = inject_effect,
          .showing = {
              .scenario = Scenario::Profile, .acting = Acting::AllButFirst, .values = shown_values, .oracle = false}};
}

}  // namespace driftlab::investigate
