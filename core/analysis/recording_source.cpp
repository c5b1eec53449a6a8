#include "core/analysis/recording_source.hpp"

namespace driftlab {

Result<RecordingView> view_of(const SourceRecording& recording) {
  const ColumnFile& columns = recording.columns;
  auto view =
      view_recording(recording.spec, columns.names(), columns.rows(), [&](std::size_t i) { return columns.column(i); });
  if (view) {
    auto& notes = view->window.quality.notes;
    notes.insert(notes.end(), recording.notes.begin(), recording.notes.end());
  }
  return view;
}

RunControl part_of(const RunControl& control, double from, double to) {
  return control.reporting([&control, from, to](std::string_view stage, double fraction) {
    control.report(stage, from + (to - from) * fraction);
  });
}

}  // namespace driftlab
