#pragma once
/// What is true of one sensor channel as it came: holes, garbage, coarse steps, a stuck or saturated sensor.
///
/// Nothing is changed: the survey says which samples are sound, and analysis takes those (core/signal/stretch.hpp).
///
/// missing      a NaN (core/signal/missing.hpp says why).
/// implausible  a number that stands for "missing" (-9999, 9999, -99999, 99999, -999) and lies more than 100 times
/// further from
///              the median than 95 % of the samples do; or any number beyond 10^6 that lies more than 10^6 times
///              further.
/// frozen       a run of one value of at least 200 samples, more than 20 times longer than every other run of the
/// channel.
///              Runs of quantised noise are geometric: the longest of n exceeds the second longest by a few of its
///              samples.
/// saturated    samples equal to the largest or smallest value, where these pile up: the channel has at least 8 values,
/// and the
///              extreme one is met 8 times or more and 5 times as often as the next inward; or is one end of a 16-bit
///              counter. The tails of a sensor within its range thin out instead.
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

/// Told of each million samples when a pass is through with them, so that the pages of a mapped file may go and memory
/// stays flat (ColumnFile::release); may be empty.
using Passed = std::function<void(std::span<const double>)>;

struct ChannelSurvey {
  ChannelQuality quality;
  std::vector<std::size_t> unsound;                  ///< rows that are missing or implausible, ascending
  std::pair<std::size_t, std::size_t> frozen{0, 0};  ///< rows [first, last) of the frozen stretch
};

/// O(n) time, once or twice over the samples; memory for the unsound rows, and a copy where a value looks like garbage.
[[nodiscard]] ChannelSurvey survey_channel(const std::string& column, std::span<const double> values,
                                           const Passed& passed = {});

/// What a sensor channel may not hold: text, an infinity or a number no double holds; NaN in one sample of a thousand
/// or more; empty cells in more than 5 %. Errors: NotANumber, NonFinite, OutOfRange; each names the first `row` and the
/// `column`.
[[nodiscard]] Status check_holes(const std::string& column, std::span<const double> values, const Passed& passed = {});

/// One sentence about everything unusual in a channel; empty where there is nothing.
[[nodiscard]] std::string describe(const ChannelQuality& quality, std::size_t window_rows);

}  // namespace driftlab
