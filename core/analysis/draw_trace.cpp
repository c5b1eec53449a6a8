#include "core/analysis/draw_trace.hpp"

#include "core/read/trace_pyramid.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

/// The rows asked for: [first, end).
struct Rows {
  std::size_t first = 0;
  std::size_t end = 0;
};

/// At least one, of a file that has one.
Rows rows_between(double t0, double t1, double rate_hz, std::size_t rows) {
  const auto row_at = [&](double t) {
    return static_cast<std::size_t>(std::clamp(std::floor(t * rate_hz), 0.0, static_cast<double>(rows)));
  };
  const std::size_t first = std::min(row_at(t0), rows - 1);
  return {first, std::max(first + 1, row_at(t1))};
}

/// From the pyramid where there is one and it spares time, else from the samples.
void fill_buckets(const ColumnFile& columns, const std::filesystem::path& pyramid_path, std::size_t column,
                  const Rows& rows, std::size_t most, RecordingTrace& trace) {
  const std::size_t count = rows.end - rows.first;
  if (const std::size_t length = pyramid_stretch(count, most); length > 0) {
    if (const auto pyramid = TracePyramid::open(pyramid_path, columns)) {
      trace.buckets = pyramid->trace(columns, column, rows.first, count, most);
      trace.samples_per_bucket = length;
      return;
    }
  }
  trace.buckets = decimated_trace(columns.column(column).subspan(rows.first, count), most);
  trace.samples_per_bucket = std::max<std::size_t>(1, (count + most - 1) / most);
  for (TraceBucket& bucket : trace.buckets) {
    bucket.first += rows.first;
  }
}

/// Stretches for which `holds`, joined where they touch.
template <class Holds>
std::vector<TimeSpan> spans_where(const std::vector<TraceBucket>& buckets, std::size_t end, double rate_hz,
                                  const Holds& holds) {
  std::vector<TimeSpan> spans;
  bool open = false;
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    const std::size_t next = i + 1 < buckets.size() ? buckets[i + 1].first : end;
    const bool here = holds(buckets[i], next);
    if (here && !open) {
      spans.push_back({static_cast<double>(buckets[i].first) / rate_hz, 0.0});
    }
    if (here) {
      spans.back().t1_s = static_cast<double>(next) / rate_hz;
    }
    open = here;
  }
  return spans;
}

void add_mark(TraceMark mark, double t0, double t1, std::vector<MarkedTime>& marks, std::size_t missing = 0) {
  if (t1 > t0) {
    marks.push_back({mark, t0, t1, missing});
  }
}

/// What is known of the recording and the channel, wherever the trace lies.
void mark_survey(const TraceRequest& request, RecordingTrace& trace) {
  const auto time = [&](std::size_t row) { return static_cast<double>(row) / request.rate_hz; };
  const auto mark = [&](TraceMark kind, const SampleStretch& stretch) {
    add_mark(kind, time(stretch.row), time(stretch.row) + time(stretch.samples), trace.marks);
  };
  add_mark(TraceMark::Trim, 0.0, std::min(request.trim.start_s, trace.duration_s), trace.marks);
  add_mark(TraceMark::Trim, std::max(0.0, trace.duration_s - request.trim.end_s), trace.duration_s, trace.marks);
  for (const Gap& gap : request.survey.longest_gaps) {
    add_mark(TraceMark::Gap, (static_cast<double>(gap.row) - 1.0) / request.rate_hz, time(gap.row), trace.marks,
             gap.missing);
  }
  if (request.survey.frozen) {
    mark(TraceMark::Frozen, *request.survey.frozen);
  }
  for (const SampleStretch& wrong : request.survey.implausible) {
    mark(TraceMark::Flagged, wrong);
  }
}

/// Where the trace reaches a value at which samples pile up.
void mark_saturated(const Rails& rails, std::size_t end, double rate_hz, RecordingTrace& trace) {
  const auto at_a_rail = [&](const TraceBucket& bucket, std::size_t /*next*/) {
    return bucket.present > 0 && (rails.low == bucket.low || rails.high == bucket.high);
  };
  for (const TimeSpan& span : spans_where(trace.buckets, end, rate_hz, at_a_rail)) {
    add_mark(TraceMark::Saturated, span.t0_s, span.t1_s, trace.marks);
  }
}

}  // namespace

std::string_view name_of(TraceMark mark) {
  switch (mark) {
    case TraceMark::Gap:
      return "gap";
    case TraceMark::Frozen:
      return "frozen";
    case TraceMark::Flagged:
      return "flagged";
    case TraceMark::Saturated:
      return "saturated";
    case TraceMark::Trim:
      break;
  }
  return "trim";
}

Result<RecordingTrace> draw_trace(const ColumnFile& columns, const std::filesystem::path& pyramid_path,
                                  const TraceRequest& request) {
  RecordingTrace trace;
  trace.duration_s = static_cast<double>(columns.rows()) / request.rate_hz;
  const double t0 = request.t0_s.value_or(0.0);
  const double t1 = request.t1_s.value_or(trace.duration_s);
  if (!(t1 > t0) || columns.rows() == 0) {
    return fail(ErrorCode::InvalidArgument, "The end t1 lies after the beginning t0.", {{"parameter", "t1"}});
  }
  const Rows rows = rows_between(t0, t1, request.rate_hz, columns.rows());
  fill_buckets(columns, pyramid_path, request.column, rows, request.stretches, trace);
  for (const TraceBucket& bucket : trace.buckets) {
    trace.time_s.push_back(static_cast<double>(bucket.first) / request.rate_hz);
  }
  trace.missing =
      spans_where(trace.buckets, rows.end, request.rate_hz,
                  [](const TraceBucket& bucket, std::size_t next) { return bucket.present < next - bucket.first; });
  mark_survey(request, trace);
  if (request.survey.rails) {
    mark_saturated(*request.survey.rails, rows.end, request.rate_hz, trace);
  }
  return trace;
}

}  // namespace driftlab
