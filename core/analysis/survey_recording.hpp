#pragma once
/// The use case "survey": the facts about a recording as it came, found when it is uploaded and when its metadata are
/// changed.
///
/// The metadata are applied to the samples as an analysis applies them: roles of the columns, window, gaps, and per
/// channel which samples are missing, implausible, saturated or frozen (core/signal/channel_survey.hpp). The survey
/// also holds the marks of a drawing (the longest gaps, the ends of the range, the implausible stretches), the
/// temperature of the recording, and doubts about its units (core/datasheet/plausible_units.hpp).
///
/// A recording of a drive may have no sensor among its stated columns, but fixes or a reference path. No channel of it
/// is characterised: its columns are read as they are stated, and a note says so.
#include "core/calibrate/sensor_calibration.hpp"
#include "core/signal/full_scale.hpp"
#include "core/signal/measured_temperature.hpp"
#include "core/signal/recording.hpp"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

/// The most gaps of a recording, and the most implausible stretches of a channel, that are listed one by one. A screen
/// does not separate more.
inline constexpr std::size_t kMarksTold = 64;

struct SampleStretch {
  std::size_t row = 0;  ///< the first, from 0
  std::size_t samples = 0;
};

/// What a drawing of one channel marks.
struct ChannelMarks {
  std::optional<Rails> rails;              ///< only where samples are saturated
  std::vector<SampleStretch> implausible;  ///< the first of them, in order of their rows
};

struct RecordingSurvey {
  Quality quality;
  std::optional<MeasuredTemperature> temperature;
  std::vector<Gap> longest_gaps;    ///< of the analysed part, the earlier of equal ones, in order of their rows
  std::vector<ChannelMarks> marks;  ///< one per channel of `quality`, in its order
};

struct SurveyRequest {
  std::filesystem::path columns;  ///< a column file (core/read/column_file.hpp)
  RecordingSpec spec;
  Calibration calibration;                     ///< the one that `spec` names, empty where it names none
  std::span<const std::string> hardware = {};  ///< texts that describe the device, most telling first
};

/// Errors: those of open_recording; where `spec` names a calibration also those of apply_calibration, for metadata that
/// cannot be corrected are as wrong as metadata that cannot be read. Cost: two or three passes over the sensor columns;
/// without a calibration the pages that were read are let go.
[[nodiscard]] Result<RecordingSurvey> survey_recording(const SurveyRequest& request);

}  // namespace driftlab
