#pragma once
/// What causes of recordings at fault share: the error renewed after a repair, recordings thinned to fewer samples, and
/// a list of channels in a sentence.
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

/// error = measured - reference, where the channel had one.
void renew_error(Channel& channel);

/// The readings with their sign turned; their error is not renewed.
void turn_sign(Channel& channel);

/// A number for a sentence, four digits.
[[nodiscard]] std::string in_digits(double value);

/// Keeps every m-th sample of a recording from `phase` on: its interval becomes m times as long.
void thin_out(StudyRecording& recording, std::size_t every, std::size_t phase, std::deque<std::vector<double>>& rows);

/// Takes the grid places marked in `gone` out of every channel: they count as absent, and their rows as not written.
void leave_out(StudyRecording& recording, const std::vector<unsigned char>& gone,
               std::deque<std::vector<double>>& rows);

/// m and phase of a recording; m = 0: it is as it should be.
struct Thinning {
  std::size_t every = 0;
  std::size_t phase = 0;
};

/// The fault of all recordings that `look` finds resampled by one m. They are thinned out; recordings of the other kind
/// are set aside, whichever are fewer. `parameter` makes the reported value of a recording's m.
[[nodiscard]] std::vector<FaultyRecordings> resampled_recordings(
    const Study& study, const std::function<Thinning(const StudyRecording&)>& look,
    const std::function<FoundParameter(const StudyRecording&, std::size_t every)>& parameter, const std::string& what);

/// Takes every criticised channel of a recording out of what is examined.
void set_aside(StudyRecording& recording);

}  // namespace driftlab::investigate
