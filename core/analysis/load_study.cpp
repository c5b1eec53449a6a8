#include "core/analysis/load_study.hpp"

#include <utility>

namespace driftlab {
namespace {

/// Puts one recording into the study. `columns` keeps what it points into.
Status load(std::size_t index, RecordingSource& recordings, const RunControl& control, std::deque<ColumnFile>& columns,
            investigate::Study& study) {
  auto opened = recordings.open(index, control);
  if (!opened) {
    return fail(opened.error());
  }
  columns.push_back(std::move(opened->columns));
  const ColumnFile& table = columns.back();
  auto recording = investigate::make_study_recording(opened->spec, table.names(), table.rows(),
                                                     [&](std::size_t i) { return table.column(i); });
  if (!recording) {
    return fail(recording.error());
  }
  for (const std::string& note : recording->notes) {
    study.notes.push_back(opened->spec.id + ": " + note);
  }
  study.recordings.push_back(std::move(*recording));
  return {};
}

}  // namespace

Status load_study(RecordingSource& recordings, std::deque<ColumnFile>& columns, investigate::Study& study,
                  const RunControl& control) {
  const auto count = static_cast<double>(recordings.count());
  for (std::size_t i = 0; i < recordings.count(); ++i) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The investigation was stopped.");
    }
    const double done = static_cast<double>(i);
    control.report("load", done / count);
    if (const Status loaded = load(i, recordings, part_of(control, done / count, (done + 1.0) / count), columns, study);
        !loaded) {
      return fail(recordings.located(i, loaded.error()));
    }
  }
  investigate::settle_channels(study);
  return {};
}

}  // namespace driftlab
