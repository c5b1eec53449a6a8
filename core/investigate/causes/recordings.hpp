#pragma once
/// What the causes that repair recordings (RecordingFault in family.hpp) share: computing the error again after a
/// repair, keeping every m-th sample of a recording, and naming channels in a sentence.
#include "core/investigate/causes/family.hpp"

#include <cstddef>
#include <deque>
#include <functional>
#include <string>
#include <vector>

namespace driftlab::investigate {

[[nodiscard]] ChannelName name_of(const StudyRecording& recording, const Channel& channel);

/// "a, b and c"; of more than six the first five and "others".
[[nodiscard]] std::string list_of_names(const std::vector<std::string>& names);
[[nodiscard]] std::string list_of_names(const std::vector<ChannelName>& names);

/// Computes `error` again as `measured` - `reference`, in a channel that has an error.
void renew_error(Channel& channel);

/// Changes the sign of the readings. The error is not computed again.
void turn_sign(Channel& channel);

/// A number for a sentence, four digits.
[[nodiscard]] std::string in_digits(double value);

/// Keeps every m-th sample of a recording from `phase` on: its interval becomes m times as long.
void thin_out(StudyRecording& recording, std::size_t every, std::size_t phase, std::deque<std::vector<double>>& rows);

/// Takes the samples at the grid places marked in `gone` out of every channel, as if their rows were not in the file.
void leave_out(StudyRecording& recording, const std::vector<unsigned char>& gone,
               std::deque<std::vector<double>>& rows);

/// Which samples of a recording are the original ones: every m-th from `phase` on. m = 0: all are.
struct Thinning {
  std::size_t every = 0;
  std::size_t phase = 0;
};

/// One fault for each m by which `look` finds recordings resampled. If these are more than half of the study they are
/// thinned out and the others are set aside; otherwise they are set aside themselves. `parameter` gives the reported
/// value of a recording's m.
[[nodiscard]] std::vector<FaultyRecordings> resampled_recordings(
    const Study& study, const std::function<Thinning(const StudyRecording&)>& look,
    const std::function<FoundParameter(const StudyRecording&, std::size_t every)>& parameter, const std::string& what,
    const std::stop_token& stop);

/// Leaves every channel of a recording out of the examination; it stays an input.
void set_aside(StudyRecording& recording);

}  // namespace driftlab::investigate
