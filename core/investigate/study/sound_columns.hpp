#pragma once
/// The columns of a recording in the rows that a study examines. Internal to the study.
///
/// A row is examined where every sensor and every reference has a sample. One in which a value is missing, or only
/// stands for a missing one (core/signal/channel_survey.hpp), is a place of the grid without a sample, for all columns:
/// effects that join columns see whole rows only, and a row in a hundred costs a hundredth of the data. A temperature
/// is slow and often recorded less often than the rest, so that where it is missing it is read between its neighbours.
/// A freeze is no hole here: it is a finding (core/investigate/causes/stuck_samples.cpp).
#include "core/signal/recording_columns.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace driftlab::investigate {

struct SoundColumns {
  RecordingColumns columns;           ///< of the examined rows
  std::vector<std::size_t> left_out;  ///< rows of the file, ascending
  std::vector<std::size_t> examined;  ///< columns of sensors, in file order
  std::vector<std::string> notes;     ///< on columns that are passed over, and on rows that are left out
  /// What `columns` reads beside the file, by column; null where every row is whole.
  std::shared_ptr<const std::vector<std::vector<double>>> memory;
};

/// Of the rows of `columns`, which were read with `spec` and `names`. O(rows) time for each column; memory only
/// where a row is left out or a temperature missing. Errors: those of RecordingColumns::use_of.
[[nodiscard]] Result<SoundColumns> sound_columns(const RecordingSpec& spec, const ColumnNames& names,
                                                 RecordingColumns columns);

}  // namespace driftlab::investigate
