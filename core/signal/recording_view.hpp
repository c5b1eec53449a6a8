#pragma once
/// A recording ready for analysis: which rows, which channels, and the error series of each.
///
/// The error of a channel is measured minus reference (spec/study.md). A constant reference (static, constant rate,
/// +-g) does not change any variance and is left in, so that the samples are used where they lie in the mapped file.
/// Under a constant angular acceleration the reference on the rotation axis is the ramp from rest at the first sample
/// of the file; where a reference column of the same axis exists, it is the reference. Both need a copy of the channel.
#include "core/signal/channel_survey.hpp"
#include "core/signal/recording.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

/// One sensor channel: the longest stretch of the analysed window in which it is sound
/// (core/signal/channel_survey.hpp), so that no value is missing, implausible or frozen. What is left out stands in
/// `window.quality`.
struct ChannelView {
  std::string column;
  ColumnRole role;                 ///< unit `1` where none is stated
  std::size_t first_row = 0;       ///< row of the file that values[0] comes from
  std::span<const double> values;  ///< error series in the channel's unit; the file's memory, or `owned`
  std::vector<double> owned;       ///< filled where a reference had to be subtracted
};

struct RecordingView {
  Window window;
  std::vector<ChannelView> channels;  ///< sensors in file order
};

/// `column(i)` gives the samples of column i of the file in its own unit; they must outlive the view.
/// Errors: those of assign_roles, plan_window and, for sensor columns, check_holes; TooFewSamples; UnknownColumn (no
/// sensor column at all). O(rows) time; O(rows) memory per channel with a moving reference, none otherwise.
[[nodiscard]] Result<RecordingView> view_recording(const RecordingSpec& spec, const ColumnNames& names,
                                                   std::size_t rows,
                                                   const std::function<std::span<const double>(std::size_t)>& column,
                                                   const Passed& passed = {});

}  // namespace driftlab
