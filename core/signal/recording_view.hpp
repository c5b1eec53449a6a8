#pragma once
/// A recording prepared for analysis: the rows used, the channels, and the error series of each channel.
///
/// The error of a channel is the measured value minus the reference (spec/study.md). A constant reference (static,
/// constant rate, +-g) changes no variance and is not subtracted, so that the samples are used where they lie in the
/// mapped file. Under a constant angular acceleration the reference on the rotation axis is the ramp from rest at the
/// first sample of the file. A reference column of the same axis takes precedence. In both cases a copy of the channel
/// is needed.
#include "core/signal/channel_survey.hpp"
#include "core/signal/recording.hpp"
#include "core/signal/stretch.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace driftlab {

/// One sensor channel: the sound samples of the analysed window (core/signal/channel_survey.hpp), none of them missing,
/// implausible or frozen, and the places at which samples are missing between them. `window.quality` says what is left
/// out.
struct ChannelView {
  std::string column;
  ColumnRole role;                 ///< unit `1` where none is stated
  Stretch stretch;                 ///< rows of the file that `values` come from
  std::span<const double> values;  ///< error series in the channel's unit; the file's memory, or `owned`
  std::vector<Gap> gaps;           ///< where samples are missing between two of `values`; empty: evenly spaced
  std::vector<double> owned;       ///< filled where rows are left out or a reference had to be subtracted
  /// The reference that was subtracted, one per value, in the channel's unit; empty where none had to be.
  std::vector<double> reference;
  std::string reference_column;  ///< where it comes from; empty: from the condition

  /// The values of rows [first, first + count) of the file, which one run must hold.
  [[nodiscard]] std::span<const double> rows(std::size_t first, std::size_t count) const;
};

struct RecordingView {
  Window window;
  std::vector<ChannelView> channels;  ///< sensors in file order
  /// Where rows of the file repeat the row before them: columns of the file without these, on which `window` and
  /// `channels` then stand. Empty: nothing repeats.
  std::vector<std::vector<double>> distinct;
};

/// The longest run of rows that all of `channels` have without a gap: its first row and the number of rows (0: none).
[[nodiscard]] std::pair<std::size_t, std::size_t> longest_shared_run(std::span<const ChannelView* const> channels);

/// What a view is made for.
enum class ViewUse {
  Analysis,
  Survey  ///< only `window` is wanted: channels have no values and no reference, and memory stays flat
};

/// `column(i)` gives the samples of column i of the file in its own unit; they must outlive the view.
/// Errors: those of assign_roles, plan_window and, for sensor columns, check_holes; TooFewSamples; UnknownColumn (no
/// sensor column at all, or the fixes of a receiver alone where roles come from names; a survey takes those). O(rows)
/// time; O(rows) memory per channel with a moving reference or rows left out inside, none otherwise.
[[nodiscard]] Result<RecordingView> view_recording(const RecordingSpec& spec, const ColumnNames& names,
                                                   std::size_t rows,
                                                   const std::function<std::span<const double>(std::size_t)>& column,
                                                   ViewUse use = ViewUse::Analysis, const Passed& passed = {});

}  // namespace driftlab
