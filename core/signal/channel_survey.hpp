#pragma once
/// Survey of one sensor channel as it was recorded: missing and implausible samples, coarse resolution, a frozen or
/// saturated sensor.
///
/// Nothing is changed. The survey says which samples are sound, and the analysis uses those (core/signal/stretch.hpp).
///
/// missing: a NaN (core/signal/missing.hpp says why).
///
/// implausible: a number that stands for "missing" (-9999, 9999, -99999, 99999, -999) and lies more than 100 times
/// further from the median than 95 % of the samples do; or any number beyond 10^6 that lies more than 10^6 times
/// further.
///
/// frozen: a run of one value that lasts at least 200 samples and is more than 20 times longer than every other run of
/// the channel. The lengths of runs in quantised noise are geometrically distributed, so the longest of n runs exceeds
/// the second longest by only a few samples.
///
/// saturated: samples equal to the largest or smallest value, if these pile up. Either the channel has at least 8
/// distinct values and the extreme one occurs 8 times or more and 5 times as often as the next value inward, or the
/// extreme value is an end of a 16-bit counter. For a sensor within its range the tails thin out instead.
#include "core/signal/missing.hpp"
#include "core/signal/recording.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace driftlab {

/// Called with each million samples once a pass has finished with them. The pages of a mapped file may then be released
/// and memory stays flat (ColumnFile::release). May be empty.
using Passed = std::function<void(std::span<const double>)>;

struct ChannelSurvey {
  ChannelQuality quality;
  std::vector<std::size_t> unsound;                  ///< rows that are missing or implausible, ascending
  std::pair<std::size_t, std::size_t> frozen{0, 0};  ///< rows [first, last) of the frozen stretch
};

/// The samples are read once or twice, in O(n) time. Memory is needed for the unsound rows, and for a copy of the
/// channel if some value looks implausible.
[[nodiscard]] ChannelSurvey survey_channel(const std::string& column, std::span<const double> values,
                                           const Passed& passed = {});

/// Refuses what a sensor channel may not hold: text, an infinity or a number too large for a double; NaN in one sample
/// of a thousand or more; empty cells in more than 5 %. Errors: NotANumber, NonFinite, OutOfRange; each names the first
/// `row` and the `column`.
[[nodiscard]] Status check_holes(const std::string& column, std::span<const double> values, const Passed& passed = {});

/// One sentence about everything unusual in a channel; empty where there is nothing.
[[nodiscard]] std::string describe(const ChannelQuality& quality, std::size_t window_rows);

}  // namespace driftlab
