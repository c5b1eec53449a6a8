#pragma once
/// The recordings of a study from their source, put onto their time grids.
#include "core/analysis/recording_source.hpp"
#include "core/investigate/study/study.hpp"

#include <deque>

namespace driftlab {

/// Fills `study.recordings` and settles which channels are examined and which are inputs only (settle_channels). The
/// study points into `columns`, the opened files, which must outlive it.
/// Errors: those of the source and of make_study_recording, located; Cancelled.
[[nodiscard]] Status load_study(RecordingSource& recordings, std::deque<ColumnFile>& columns, investigate::Study& study,
                                const RunControl& control = {});

}  // namespace driftlab
