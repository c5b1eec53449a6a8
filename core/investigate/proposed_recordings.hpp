#pragma once
/// Recordings that a laboratory could make next, as study recordings whose columns hold no readings yet.
///
/// Each proposal is a small set made in one go: a longer rest, several short ones, constant rates of both signs, a
/// profile with a reference, a rest through rising and falling temperature. Lengths follow the recordings there are.
#include "core/investigate/study/study.hpp"

#include <deque>
#include <string>
#include <vector>

namespace driftlab::investigate {

struct ProposedRecordings {
  std::string title;  ///< "four constant rates of both signs"
  std::vector<Condition> conditions = {};
  double duration_s = 0.0;  ///< of each
  double rate_hz = 0.0;
  std::vector<std::string> columns = {};  ///< what the recordings must hold, for people
  std::vector<StudyRecording> blank = {};
};

/// For one channel group; `memory` keeps the columns that the recordings point into. A proposal that cannot be made for
/// the channel (a rate for an accelerometer) is left out.
[[nodiscard]] std::vector<ProposedRecordings> proposed_recordings(const ChannelGroup& group,
                                                                  std::deque<std::vector<double>>& memory);

}  // namespace driftlab::investigate
