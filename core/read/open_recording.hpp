#pragma once
/// A decoded recording, opened for analysis: the mapped columns and what they mean.
#include "core/read/column_file.hpp"
#include "core/signal/recording_view.hpp"

#include <filesystem>

namespace driftlab {

/// The view points into the columns and lives as long as they do; both may be moved together.
struct OpenRecording {
  ColumnFile columns;
  RecordingView view;
};

/// For a survey the pages that were read are let go. Errors: those of ColumnFile::open and view_recording. Cost: one or
/// two passes over the sensor columns.
[[nodiscard]] Result<OpenRecording> open_recording(const std::filesystem::path& columns, const RecordingSpec& spec,
                                                   ViewUse use = ViewUse::Analysis);

}  // namespace driftlab
