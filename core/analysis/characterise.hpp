#pragma once
/// The use case "characterise": recordings in; variances, Allan coefficients and ranked error models of each of their
/// channels out.
///
/// Per recording: readings are corrected by the calibration that it names, references are put in time
/// (core/calibrate/aligned_reference.hpp) and subtracted, and each channel is characterised in file order
/// (core/fit/characterise.hpp).
#include "core/analysis/recording_source.hpp"
#include "core/calibrate/aligned_reference.hpp"
#include "core/campaign/sensor_sources.hpp"
#include "core/fit/characterise.hpp"
#include "core/signal/measured_temperature.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace driftlab {

struct CharacterisedChannel {
  std::string column;
  ColumnRole role;
  ChannelCharacterisation result;
  std::optional<ReferenceAlignment> reference;  ///< where the channel has a reference column
};

struct CharacterisedRecording {
  RecordingSpec spec;
  Window window;                                        ///< time base and quality
  std::optional<MeasuredTemperature> temperature = {};  ///< where the recording has a column of it
  std::vector<CharacterisedChannel> channels;
  std::string device = {};  ///< name of the device, as its source has it
};

/// A recording whose channels can be characterised, each for itself and in any order.
class PreparedRecording {
 public:
  /// Errors: those of apply_calibration.
  [[nodiscard]] static Result<PreparedRecording> make(const RecordingSpec& spec, RecordingView view,
                                                      const Calibration& calibration);
  /// Recording `index` < recordings.count(), opened. Errors, located: those of the source, of view_recording and of
  /// `make`; Cancelled.
  [[nodiscard]] static Result<PreparedRecording> open(RecordingSource& recordings, std::size_t index,
                                                      const RunControl& control);

  [[nodiscard]] std::size_t channels() const { return view_.channels.size(); }
  /// Errors: those of characterise_channel, with field "column"; Cancelled.
  [[nodiscard]] Result<CharacterisedChannel> characterise(std::size_t channel, const CharacteriseOptions& options,
                                                          const RunControl& control) const;
  /// What is said of the recording as a whole: a CharacterisedRecording without channels.
  [[nodiscard]] const CharacterisedRecording& frame() const { return frame_; }

 private:
  PreparedRecording() = default;

  std::optional<ColumnFile> columns_;  ///< into which `view_` points, where this object opened them
  RecordingView view_;
  std::vector<ReferenceAlignment> alignments_;
  CharacterisedRecording frame_;
};

/// All channels of a prepared recording, those of a short one as tasks of `control.threads`. Progress runs over them.
/// Errors: those of PreparedRecording::characterise; of several channels that fail, that of the first.
[[nodiscard]] Result<CharacterisedRecording> characterise_recording(const PreparedRecording& recording,
                                                                    const CharacteriseOptions& options,
                                                                    const RunControl& control);

/// All recordings, one after the other and none kept open. Errors, located: those of PreparedRecording.
[[nodiscard]] Result<std::vector<CharacterisedRecording>> characterise(RecordingSource& recordings,
                                                                       const CharacteriseOptions& options,
                                                                       const RunControl& control);

/// The id under which whoever asks will store the result of a recording's column: rows of tables and members of pooled
/// axes then name it.
using ResultName = std::function<std::string(const std::string& recording, const std::string& column)>;

/// A fact about a recording or one of its channels that a reader of its figures must know.
struct Remark {
  std::string whose;  ///< id of the recording; `id, channel` of a channel
  std::string sentence;

  friend bool operator==(const Remark&, const Remark&) = default;
};

/// The notes of each recording's quality, then the warnings of its channels.
[[nodiscard]] std::vector<Remark> remarks_of(const std::vector<CharacterisedRecording>& recordings);

/// Their channels by sensor axis, in order of appearance: what a campaign's summary is made of
/// (core/campaign/campaign_summary.hpp).
[[nodiscard]] std::vector<SensorSources> sensors_of(const std::vector<CharacterisedRecording>& recordings,
                                                    const ResultName& result_name = {});

}  // namespace driftlab
