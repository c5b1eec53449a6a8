#include "core/investigate/search/right_recordings.hpp"

#include "core/investigate/causes/recordings.hpp"

#include <utility>

namespace driftlab::investigate {
namespace {

SetAside describe(const StudyRecording& recording, const Channel& channel, const DoubtfulRecording& doubt) {
  SetAside aside{recording.id, channel.column, recording.id + "/" + channel.column, doubt.factor, doubt.deviation};
  if (doubt.doubt == RecordingDoubt::NoResponse) {
    aside.sentence.append(" does not see the motion that is stated, and no other axis does");
  } else {
    aside.sentence.append(" shows ")
        .append(in_digits(doubt.factor))
        .append(" of the motion that is stated, where other recordings show all of it: check its condition");
  }
  aside.sentence.append(". It is set aside.");
  return aside;
}

}  // namespace

RightedRecordings right_recordings(const Study& study, const std::stop_token& stop) {
  RightedRecordings righted;
  const auto present = [&]() -> const Study& { return righted.study ? *righted.study : study; };
  for (const Cause& cause : cause_registry()) {
    const RecordingFault* const family = cause.as<RecordingFault>();
    if (family == nullptr || stop.stop_requested()) {
      continue;
    }
    std::vector<FaultyRecordings> found = family->find(present(), stop);
    if (stop.stop_requested()) {
      break;
    }
    for (FaultyRecordings& fault : found) {
      if (!righted.study) {
        righted.study = study;
      }
      fault.mend(*righted.study, righted.rows);
      righted.findings.push_back({&cause, std::move(fault)});
    }
  }
  if (stop.stop_requested()) {
    return righted;
  }
  for (const DoubtfulRecording& doubt : doubtful_recordings(present(), stop)) {
    const bool named = doubt.doubt != RecordingDoubt::NoResponse && doubt.doubt != RecordingDoubt::OddGain;
    if (named) {
      continue;
    }
    if (!righted.study) {
      righted.study = study;
    }
    StudyRecording& recording = righted.study->recordings[doubt.recording];
    Channel& channel = recording.channels[doubt.channel];
    righted.aside.push_back(describe(recording, channel, doubt));
    channel.input_only = true;
  }
  return righted;
}

}  // namespace driftlab::investigate
