#pragma once
/// The use case "draw a recording": the samples of one column between two times as a screen can show them, with what a
/// reader must not take for the sensor's noise marked.
///
/// Times count from the first row (core/analysis/row_clock.hpp). A stretch of the answer holds the least, greatest and
/// mean value of its samples (core/signal/decimated_trace.hpp); for many samples they come from the pyramid beside the
/// columns (core/read/trace_pyramid.hpp). In each gap that the survey tells of stands a stretch without a sample, so
/// that no line is drawn across it.
#include "core/analysis/survey_recording.hpp"
#include "core/read/column_file.hpp"
#include "core/signal/decimated_trace.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace driftlab {

/// What a survey left of one channel for its drawing.
struct SurveyedChannel {
  std::vector<Gap> longest_gaps;           ///< of the recording
  std::size_t missing = 0;                 ///< samples in all of its gaps
  std::optional<SampleStretch> frozen;     ///< in which the sensor gives one value only
  std::vector<SampleStretch> implausible;  ///< numbers that are no measurements
  std::optional<Rails> rails;              ///< values at which samples pile up
};

struct TraceRequest {
  std::size_t column = 0;
  double rate_hz = 1.0;        ///< rows over the time they take, gaps and all
  std::optional<double> t0_s;  ///< nothing: the beginning
  std::optional<double> t1_s;  ///< nothing: the end
  std::size_t stretches = 1;   ///< at most so many, at least 1
  Trim trim;
  SurveyedChannel survey;
};

enum class TraceMark { Trim, Gap, Frozen, Flagged, Saturated };

/// `trim`, `gap`, `frozen`, `flagged` (implausible numbers), `saturated`.
[[nodiscard]] std::string_view name_of(TraceMark mark);

struct MarkedTime {
  TraceMark mark = TraceMark::Trim;
  double t0_s = 0.0;
  double t1_s = 0.0;
  std::size_t missing = 0;  ///< samples, of a gap
};

struct TimeSpan {
  double t0_s = 0.0;
  double t1_s = 0.0;
};

struct RecordingTrace {
  std::vector<TraceBucket> buckets;  ///< `first` counts from the first row
  std::vector<double> time_s;        ///< at which each of them begins
  std::size_t samples_per_bucket = 1;
  double rate_hz = 0.0;           ///< of the rows between gaps
  double duration_s = 0.0;        ///< of the recording
  std::vector<TimeSpan> missing;  ///< stretches that lack samples, joined where they touch
  std::vector<MarkedTime> marks;  ///< trims, gaps, frozen, flagged, saturated, in this order
};

/// `pyramid_path`: where the pyramid of `columns` is, if there is one. Error: InvalidArgument, parameter "t1", where
/// the end does not lie after the beginning. Cost: one pass over the samples asked for, or over their nodes of the
/// pyramid.
[[nodiscard]] Result<RecordingTrace> draw_trace(const ColumnFile& columns, const std::filesystem::path& pyramid_path,
                                                const TraceRequest& request);

}  // namespace driftlab
