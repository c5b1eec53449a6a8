#pragma once
/// Where a use case gets its recordings from: files on this machine, or what a server has stored.
///
/// A use case (one file of this folder each) asks for recordings one after the other, by their place in the request,
/// and never learns where they come from. The command line decodes a file into a temporary column file
/// (clients/cli/local_files.hpp); the server maps the column file that an upload left
/// (server/jobs/stored_recordings.hpp).
#include "core/calibrate/sensor_calibration.hpp"
#include "core/read/column_file.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/recording_view.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// One recording, ready to be analysed. Views of it point into `columns` and live as long as these do.
struct SourceRecording {
  RecordingSpec spec;  ///< `id` is the name by which the result calls the recording
  ColumnFile columns;
  std::vector<std::string> notes;  ///< what its decoding had to say; empty where that was said elsewhere
  /// Texts that describe the device, in which its sensor may be named, most telling first.
  std::vector<std::string> hardware = {};
  std::string device = {};  ///< name of the device
};

class RecordingSource {
 public:
  RecordingSource() = default;
  RecordingSource(const RecordingSource&) = delete;
  RecordingSource& operator=(const RecordingSource&) = delete;
  virtual ~RecordingSource() = default;

  [[nodiscard]] virtual std::size_t count() const = 0;

  /// Recording `index` < count(). Polls `control.stop` and reports progress where opening takes long. Errors: whatever
  /// keeps the recording from being read; Cancelled.
  [[nodiscard]] virtual Result<SourceRecording> open(std::size_t index, const RunControl& control) = 0;

  /// The calibration that the recording names, empty where it names none. Asked for after `open`, and only by use cases
  /// that correct readings.
  [[nodiscard]] virtual Result<Calibration> calibration(std::size_t index) = 0;

  /// An error that concerns recording `index`, with its place in the words of whoever asked: a path, an id, a pointer.
  [[nodiscard]] virtual Error located(std::size_t index, Error error) const = 0;

  /// How much of the time of one recording its opening may take, from 0 to 1. Only the progress bar follows it.
  [[nodiscard]] virtual double opening_share() const { return 0.0; }
};

/// The recording's window and error series (core/signal/recording_view.hpp), with the notes of its decoding behind
/// those of the view. Errors: those of view_recording.
[[nodiscard]] Result<RecordingView> view_of(const SourceRecording& recording);

/// `control`, which must outlive it, with its progress mapped onto [from, to] of the whole.
[[nodiscard]] RunControl part_of(const RunControl& control, double from, double to);

}  // namespace driftlab
