#include "core/analysis/toy.hpp"

#include <numeric>

namespace driftlab {

Result<ToyReport> toy(RecordingSource& recordings, const RunControl& control) {
  ToyReport report;
  for (std::size_t i = 0; i < recordings.count(); ++i) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The toy was cancelled.");
    }
    const auto recording = recordings.open(i, control);
    if (!recording) {
      return fail(recordings.located(i, recording.error()));
    }
    const auto view = view_of(*recording);
    if (!view) {
      return fail(recordings.located(i, view.error()));
    }
    for (const ChannelView& channel : view->channels) {
      const double sum = std::accumulate(channel.values.begin(), channel.values.end(), 0.0);
      report.means.push_back({recording->spec.id, channel.column, sum / static_cast<double>(channel.values.size())});
    }
  }
  return report;
}

}  // namespace driftlab
