#pragma once
/// Whether a reference column is good enough to stand for the true value.
///
/// error = measured - reference contains the errors of the reference too. A regression of the error on a reference with
/// noise variance s^2 is biased by -s^2 / var(reference) (errors in variables; Fuller 1987, section 1.1), so a noisy
/// reference produces an apparent scale factor error. If the reference does not follow the motion at all, because of a
/// wrong clock, axis or sign, nothing that is seen in the error can be attributed to the sensor.
#include "core/investigate/study/study.hpp"

#include <string>
#include <string_view>

namespace driftlab::investigate {

/// Standard deviation of the white noise of a series on its grid [SI], from its third differences: (1, -3, 3, -1) takes
/// motion out up to its third derivative and multiplies white variance by 20. 0 below eight samples.
[[nodiscard]] double noise_of_third_differences(const Series& values, std::size_t begin, std::size_t end);

/// Time stamps of some recording with a reference scatter by more than kLooseStamps samples (measured_constants.hpp):
/// the reference is read at other times than the channel's.
[[nodiscard]] bool stamps_are_loose(const ChannelGroup& group);
inline constexpr std::string_view kTightStamps =
    "time stamps of the sampling itself, that scatter by less than a sample";

/// What a reference would need before the error may be regressed on it; empty if it is good enough. It is not good
/// enough if stamps are loose, or if its own white noise exceeds that of the channel in some recording.
[[nodiscard]] std::string reference_lacks(const ChannelGroup& group);

/// What is wrong if one-second means of channel and reference are poorly correlated (below kLeastCorrelation) although
/// the reference moves far beyond the channel's noise; empty if nothing is.
[[nodiscard]] std::string why_reference_misleads(const ChannelGroup& group);

}  // namespace driftlab::investigate
