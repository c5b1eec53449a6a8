#pragma once
/// Whether a reference column can be taken for the truth.
///
/// error = measured - reference holds the reference's own errors too. A regression of the error on a reference of noise
/// variance s^2 is pulled by -s^2 / var(reference) (errors in variables; Fuller 1987, section 1.1): a noisy reference
/// shows a scale factor that is not there. And a reference that does not follow the motion at all, by a wrong clock,
/// axis or sign, makes everything that is seen in the error an untruth.
#include "core/investigate/study/study.hpp"

#include <string>
#include <string_view>

namespace driftlab::investigate {

/// Standard deviation of the white noise of a series on its grid [SI], from its third differences: (1, -3, 3, -1) takes
/// motion out up to its third derivative and multiplies white variance by 20. 0 below eight samples.
[[nodiscard]] double noise_of_third_differences(const std::vector<double>& values, std::size_t begin, std::size_t end);

/// Time stamps of some recording with a reference scatter by more than kLooseStamps samples (measured_constants.hpp):
/// the reference is read at other times than the channel's.
[[nodiscard]] bool stamps_are_loose(const ChannelGroup& group);
inline constexpr std::string_view kTightStamps =
    "time stamps of the sampling itself, that scatter by less than a sample";

/// What a reference would need before the error may be regressed on it; empty where it is good enough. It is not where
/// stamps are loose, or where its own white noise exceeds the channel's in some recording.
[[nodiscard]] std::string reference_lacks(const ChannelGroup& group);

/// What is wrong where means over a second of channel and reference do not go together (correlation below
/// kLeastCorrelation) although the reference moves far beyond the channel's noise; empty where nothing is.
[[nodiscard]] std::string why_reference_misleads(const ChannelGroup& group);

}  // namespace driftlab::investigate
