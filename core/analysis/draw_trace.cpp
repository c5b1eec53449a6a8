#include "core/analysis/draw_trace.hpp"

#include "core/analysis/row_clock.hpp"
#include "core/read/trace_pyramid.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {
namespace {

/// The rows asked for: [first, end).
struct Rows {
  std::size_t first = 0;
  std::size_t end = 0;
};

/// At least one, of a file that has one.
Rows rows_between(double t0, double t1, const RowClock& clock, std::size_t rows) {
  const std::size_t first = std::min(clock.row_at(t0), rows - 1);
  return {first, std::max(first + 1, clock.row_at(t1))};
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
std::vector<TimeSpan> spans_where(const std::vector<TraceBucket>& buckets, std::size_t end, const RowClock& clock,
                                  const Holds& holds) {
  std::vector<TimeSpan> spans;
  bool open = false;
  for (std::size_t i = 0; i < buckets.size(); ++i) {
    const std::size_t next = i + 1 < buckets.size() ? buckets[i + 1].first : end;
    const bool here = holds(buckets[i], next);
    if (here && !open) {
      spans.push_back({clock.begin_of(buckets[i].first), 0.0});
    }
    if (here) {
      spans.back().t1_s = clock.end_before(next);
    }
    open = here;
  }
  return spans;
}

/// A stretch without a sample where each gap within the trace begins.
void part_at_gaps(const std::vector<Gap>& gaps, const RowClock& clock, const Rows& rows, RecordingTrace& trace) {
  std::vector<TraceBucket> buckets;
  std::vector<double> times;
  auto gap = std::find_if(gaps.begin(), gaps.end(), [&](const Gap& one) { return one.row > rows.first; });
  const auto part_before = [&](std::size_t row) {
    for (; gap != gaps.end() && gap->row <= row && gap->row < rows.end; ++gap) {
      buckets.push_back({gap->row, 0, 0.0, 0.0, 0.0});
      times.push_back(clock.end_before(gap->row));
    }
  };
  for (std::size_t i = 0; i < trace.buckets.size(); ++i) {
    part_before(trace.buckets[i].first);
    buckets.push_back(trace.buckets[i]);
    times.push_back(trace.time_s[i]);
  }
  part_before(rows.end);
  trace.buckets = std::move(buckets);
  trace.time_s = std::move(times);
}

void add_mark(TraceMark mark, double t0, double t1, std::vector<MarkedTime>& marks, std::size_t missing = 0) {
  if (t1 > t0) {
    marks.push_back({mark, t0, t1, missing});
  }
}

/// What is known of the recording and the channel, wherever the trace lies.
void mark_survey(const TraceRequest& request, const RowClock& clock, RecordingTrace& trace) {
  const auto mark = [&](TraceMark kind, const SampleStretch& stretch) {
    add_mark(kind, clock.begin_of(stretch.row), clock.end_before(stretch.row + stretch.samples), trace.marks);
  };
  add_mark(TraceMark::Trim, 0.0, std::min(request.trim.start_s, trace.duration_s), trace.marks);
  add_mark(TraceMark::Trim, std::max(0.0, trace.duration_s - request.trim.end_s), trace.duration_s, trace.marks);
  for (const Gap& gap : request.survey.longest_gaps) {
    add_mark(TraceMark::Gap, clock.begin_of(gap.row - 1), clock.begin_of(gap.row), trace.marks, gap.missing);
  }
  if (request.survey.frozen) {
    mark(TraceMark::Frozen, *request.survey.frozen);
  }
  for (const SampleStretch& wrong : request.survey.implausible) {
    mark(TraceMark::Flagged, wrong);
  }
}

/// Where the trace reaches a value at which samples pile up.
void mark_saturated(const Rails& rails, std::size_t end, const RowClock& clock, RecordingTrace& trace) {
  const auto at_a_rail = [&](const TraceBucket& bucket, std::size_t /*next*/) {
    return bucket.present > 0 && (rails.low == bucket.low || rails.high == bucket.high);
  };
  for (const TimeSpan& span : spans_where(trace.buckets, end, clock, at_a_rail)) {
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
  const RowClock clock(request.rate_hz, columns.rows(), request.survey.missing, request.survey.longest_gaps);
  RecordingTrace trace;
  trace.rate_hz = clock.rate_hz();
  trace.duration_s = clock.end_before(columns.rows());
  const double t0 = request.t0_s.value_or(0.0);
  const double t1 = request.t1_s.value_or(trace.duration_s);
  if (!(t1 > t0) || columns.rows() == 0) {
    return fail(ErrorCode::InvalidArgument, "The end t1 lies after the beginning t0.", {{"parameter", "t1"}});
  }
  const Rows rows = rows_between(t0, t1, clock, columns.rows());
  fill_buckets(columns, pyramid_path, request.column, rows, request.stretches, trace);
  for (const TraceBucket& bucket : trace.buckets) {
    trace.time_s.push_back(clock.begin_of(bucket.first));
  }
  trace.missing = spans_where(trace.buckets, rows.end, clock, [](const TraceBucket& bucket, std::size_t next) {
    return bucket.present < next - bucket.first;
  });
  mark_survey(request, clock, trace);
  if (request.survey.rails) {
    mark_saturated(*request.survey.rails, rows.end, clock, trace);
  }
  part_at_gaps(request.survey.longest_gaps, clock, rows, trace);
  return trace;
}

}  // namespace driftlab
