#pragma once
/// The use case "survey": the facts about a recording as it came, found when it is uploaded and when its metadata are
/// changed.
///
/// Metadata and samples are held against each other as an analysis would: roles of the columns, window, gaps, and per
/// channel what is missing, implausible, saturated or frozen (core/signal/channel_survey.hpp). With it goes what a
/// drawing of the samples marks (the longest gaps, the ends of the range, the stretches that are no measurements), how
/// warm the recording was, and what speaks against its units (core/datasheet/plausible_units.hpp).
///
/// A drive's recording whose stated columns are no sensors (fixes, a reference path) is characterised by nothing: its
/// columns are read as they are stated, and a note says so.
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

/// So many gaps of a recording, and stretches of a channel, are told one by one: more than a screen tells apart.
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
