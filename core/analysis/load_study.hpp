#pragma once
/// The recordings of a study from their source, put onto their time grids.
#include "core/analysis/recording_source.hpp"
#include "core/investigate/study/study.hpp"

#include <deque>

namespace driftlab {

/// Fills `study.recordings` and settles which channels are criticised. `columns` keeps what the study points into.
/// Errors: those of the source and of make_study_recording, located; Cancelled.
[[nodiscard]] Status load_study(RecordingSource& recordings, std::deque<ColumnFile>& columns, investigate::Study& study,
                                const RunControl& control = {});

}  // namespace driftlab
