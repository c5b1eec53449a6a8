#include "core/signal/kept_rows.hpp"
#include "core/signal/no_rate.hpp"
#include "core/signal/number.hpp"
#include "core/signal/recording.hpp"
#include "core/signal/spacing.hpp"
#include "core/signal/stretch.hpp"
#include "core/signal/time_column.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

/// Within this the stamps confirm the stated rate and 1/rate_hz is the sample interval; decimal stamps round that much.
constexpr double kRateConfirmed = 1e-6;

Status check_settings(const RecordingSpec& spec) {
  if (spec.rate_hz && !is_sampling_rate(*spec.rate_hz)) {
    return fail(ErrorCode::InvalidArgument, "The sampling rate must be from 1e-6 to 1e9 Hz.",
                {{"parameter", "rate_hz"}});
  }
  if (!(spec.trim.start_s >= 0.0 && std::isfinite(spec.trim.start_s))) {
    return fail(ErrorCode::InvalidArgument, "A trim must be zero or a positive number of seconds.",
                {{"parameter", "trim.start_s"}});
  }
  if (!(spec.trim.end_s >= 0.0 && std::isfinite(spec.trim.end_s))) {
    return fail(ErrorCode::InvalidArgument, "A trim must be zero or a positive number of seconds.",
                {{"parameter", "trim.end_s"}});
  }
  return {};
}

tl::unexpected<Error> trimmed_away(const RecordingSpec& spec, double duration_s) {
  const char* const parameter = spec.trim.start_s >= spec.trim.end_s ? "trim.start_s" : "trim.end_s";
  return fail(ErrorCode::TooFewSamples,
              "Trims of " + short_text(spec.trim.start_s) + " s and " + short_text(spec.trim.end_s) +
                  " s leave fewer than two samples of a recording of " + short_text(duration_s) + " s.",
              {{"parameter", parameter}});
}

Result<Window> plan_uniform(const RecordingSpec& spec, std::size_t rows) {
  if (!spec.rate_hz) {
    return neither_time_nor_rate();
  }
  const KeptRows kept = kept_rows(spec.trim, 1.0 / *spec.rate_hz, rows);
  if (kept.count() < 2) {
    return trimmed_away(spec, static_cast<double>(rows - 1) / *spec.rate_hz);
  }
  Window window;
  window.time.dt_s = 1.0 / *spec.rate_hz;
  window.first = kept.first;
  window.time.first_s = window.time.dt_s * static_cast<double>(kept.first);
  window.count = kept.count();
  window.quality.samples = rows;
  window.quality.analysed = window.count;
  return window;
}

/// A time column that never advances says nothing; a stated rate does.
Result<Window> plan_standing_clock(const RecordingSpec& spec, std::size_t rows) {
  if (!spec.rate_hz) {
    return fail(ErrorCode::InconsistentSampling, "The time column never advances.");
  }
  auto window = plan_uniform(spec, rows);
  if (window) {
    window->quality.notes.emplace_back("The time column never advances and is not used; the stated rate is.");
  }
  return window;
}

/// Rows [first, last) of a part of the recording, and of the rows that the trims leave.
struct Rows {
  std::size_t first = 0;
  std::size_t last = 0;
  [[nodiscard]] std::size_t count() const { return last - first; }
};

/// The rows between whose stamps a mean interval is measured, of rows whose stamps do not fall. Where samples share a
/// stamp (a clock of whole seconds, a FIFO that is read at once), the recording may begin and end within such a group,
/// and from the first row to the last there are up to two groups of samples more than the stamps have time for: 105.2
/// Hz in 20 s of 100 Hz stamped in whole seconds. From the first row of the second group to the first row of the last
/// one there are as many samples as the time is long. Without shared stamps at its ends all of it counts. `last` is the
/// later of the two rows itself, so that `count` is the number of steps between them.
Rows timed_rows(std::span<const double> stamps, Rows rows) {
  const auto begin = stamps.begin() + static_cast<std::ptrdiff_t>(rows.first);
  const auto end = stamps.begin() + static_cast<std::ptrdiff_t>(rows.last);
  const auto second = std::upper_bound(begin, end, *begin);
  const auto last = std::lower_bound(begin, end, *(end - 1));
  const bool shared = second - begin > 1 || end - last > 1;
  if (!shared || last <= second) {
    return {rows.first, rows.last - 1};
  }
  return {static_cast<std::size_t>(second - stamps.begin()), static_cast<std::size_t>(last - stamps.begin())};
}

/// Samples a second over all rows, losses as they are.
double measured_rate(const TimeColumn& time) {
  if (!time.backward.empty()) {
    return static_cast<double>(time.stamps.size() - 1) / time.advanced_s();
  }
  const Rows timed = timed_rows(time.stamps, {0, time.stamps.size()});
  return static_cast<double>(timed.count()) / (time.stamps[timed.last] - time.stamps[timed.first]);
}

Quality survey(const TimeColumn& time, const Spacing& spacing) {
  const std::vector<double>& stamps = time.stamps;
  Quality quality;
  quality.samples = stamps.size();
  quality.repeated_stamps = spacing.repeated_stamps;
  quality.gaps = spacing.long_steps.size();
  quality.jitter_s = spacing.jitter_s;
  quality.bursts = spacing.bursts;
  quality.backward_steps = time.backward.size();
  quality.counter_wraps = time.wraps;
  for (const std::size_t row : spacing.long_steps) {
    quality.longest_gap_s = std::max(quality.longest_gap_s, stamps[row] - stamps[row - 1]);
  }
  quality.measured_rate_hz = measured_rate(time);
  return quality;
}

/// The part of rows [first, last) to analyse: between two steps back, with the gaps in it.
Stretch stretch_between(std::size_t first, std::size_t last, const std::vector<std::size_t>& backward,
                        const std::vector<Gap>& gaps) {
  Stretch best;
  const auto take = [&](std::size_t end) {
    Stretch part = choose_stretch(cut_at_gaps(first, end, gaps));
    if (part.rows() > best.rows()) {
      best = std::move(part);
    }
    first = end;
  };
  for (const std::size_t row : backward) {
    if (row > first && row < last) {
      take(row);
    }
  }
  take(last);
  return best;
}

/// Compares the rate of the analysed stretch with the stated one and settles the sample interval.
Status settle_rate(const RecordingSpec& spec, const Unit& unit, double measured_dt_s, Window& window) {
  const bool unit_known = unit.dimension == Dimension::Time;
  const double measured_hz = 1.0 / measured_dt_s;
  window.time.dt_s = measured_dt_s;
  if (!spec.rate_hz) {
    if (!unit_known) {
      return fail(ErrorCode::InconsistentSampling,
                  "The time column has no unit and no rate is stated: give its unit (columns NAME=time:s, or ms, us, "
                  "ns) or rate_hz.",
                  {{"parameter", "rate_hz"}});
    }
    return {};
  }
  window.quality.clock_ratio = measured_hz / *spec.rate_hz;
  const double difference = std::abs(measured_hz / *spec.rate_hz - 1.0);
  if (difference > kRateTolerance) {
    return rates_disagree(*spec.rate_hz, measured_hz, unit_known);
  }
  if (difference <= kRateConfirmed) {
    window.time.dt_s = 1.0 / *spec.rate_hz;
  } else {
    window.quality.notes.push_back("The time column says " + short_text(measured_hz) + " Hz where " +
                                   short_text(*spec.rate_hz) + " Hz is stated; the time column is used.");
  }
  if (!unit_known) {
    window.quality.notes.emplace_back(
        "The time column has no unit; it is read in seconds, which agrees with the rate.");
  }
  return {};
}

/// The part between two steps back that `row` lies in.
Rows part_around(std::size_t row, const std::vector<std::size_t>& backward, Rows all) {
  for (const std::size_t step : backward) {
    if (step <= row) {
      all.first = std::max(all.first, step);
    } else {
      all.last = std::min(all.last, step);
    }
  }
  return all;
}

/// What was done where the clock was set back: which part is analysed, and how much that leaves out.
std::string split_text(const std::vector<std::size_t>& backward, Rows part, Rows all) {
  if (part.count() == all.count()) {
    return "; the recording is split there.";
  }
  return (backward.size() == 1 ? ", before sample " + std::to_string(backward.front() + 1) : std::string()) +
         "; the recording is split there and its longest part analysed, samples " + std::to_string(part.first + 1) +
         " to " + std::to_string(part.last) + "; the other " + std::to_string(all.count() - part.count()) +
         " are left out.";
}

void note_irregularities(Rows all, const TimeColumn& time, Window& window) {
  Quality& quality = window.quality;
  const Rows part = part_around(window.first, time.backward, all);
  if (quality.repeated_stamps > 0) {
    quality.notes.push_back(with_count(quality.repeated_stamps, "time stamp repeats the one before.",
                                       "time stamps repeat the one before."));
  }
  if (quality.gaps > 0) {
    quality.notes.push_back("The time column has " + with_count(quality.gaps, "gap, of ", "gaps, the longest ") +
                            short_text(quality.longest_gap_s) + " s.");
  }
  if (quality.bursts) {
    quality.notes.push_back("Time stamps come in bursts; the samples are read as evenly spaced by their mean step, " +
                            short_text(window.time.dt_s) + " s.");
  }
  if (quality.counter_wraps > 0) {
    quality.notes.push_back("The counter in the time column started again " + how_often(quality.counter_wraps) +
                            "; it is continued.");
  }
  if (quality.backward_steps > 0) {
    quality.notes.push_back("The time column steps back " + how_often(quality.backward_steps) +
                            (quality.backward_steps == 1 ? ", by " : ", by at most ") +
                            short_text(time.largest_step_back_s) + " s" + split_text(time.backward, part, all));
  }
  if (quality.missing > 0) {
    quality.notes.push_back(
        with_count(quality.missing, "sample is missing in the gaps of the analysed part; nothing is put in its place.",
                   "samples are missing in the gaps of the analysed part; nothing is put in their place."));
  }
  if (window.count < part.count()) {
    quality.notes.push_back("Too much is missing to analyse the recording as one: " + std::to_string(window.count) +
                            " of " + std::to_string(part.count()) + " samples are analysed, from sample " +
                            std::to_string(window.first + 1) + ".");
  }
}

/// Rows [first, last) that the trims leave. Rows at exactly the trim stay; the slack absorbs the rounding of decimal
/// stamps.
std::pair<std::size_t, std::size_t> trimmed_rows(const RecordingSpec& spec, const std::vector<double>& stamps,
                                                 double slack) {
  const double start = stamps.front() + spec.trim.start_s - slack;
  const double end = stamps.back() - spec.trim.end_s + slack;
  const auto begin = std::find_if(stamps.begin(), stamps.end(), [start](double stamp) { return stamp >= start; });
  const auto behind = std::find_if(stamps.rbegin(), stamps.rend(), [end](double stamp) { return stamp <= end; }).base();
  return {static_cast<std::size_t>(begin - stamps.begin()), static_cast<std::size_t>(behind - stamps.begin())};
}

Result<Window> plan_stamped(const RecordingSpec& spec, std::span<const double> column, const Unit& unit) {
  auto time = read_time_column(column, unit);
  if (!time) {
    return fail(time.error());
  }
  const std::vector<double>& stamps = time->stamps;
  const Spacing spacing = find_spacing(stamps, time->backward, spec.rate_hz ? 1.0 / *spec.rate_hz : 0.0);
  if (spacing.interval_s <= 0.0) {
    return plan_standing_clock(spec, column.size());
  }
  Window window;
  window.quality = survey(*time, spacing);
  window.time.start_s = stamps.front();
  const auto [first, last] = trimmed_rows(spec, stamps, 1e-6 * spacing.interval_s);
  if (last < first + 2) {
    return trimmed_away(spec, stamps.back() - stamps.front());
  }
  const Stretch stretch = stretch_between(first, last, time->backward, spacing.gaps);
  window.first = stretch.runs.front().first;
  window.count = stretch.rows();
  window.time.first_s = stamps[window.first] - stamps.front();
  for (std::size_t i = 1; i < stretch.runs.size(); ++i) {
    window.gaps.push_back({stretch.runs[i].first, stretch.runs[i].missing});
  }
  window.quality.analysed = window.count;
  window.quality.missing = stretch.missing();
  const Rows timed = timed_rows(stamps, {window.first, window.first + window.count});
  const double span = stamps[timed.last] - stamps[timed.first];
  if (window.count < 2 || span <= 0.0) {
    return fail(ErrorCode::TooFewSamples, "No two consecutive samples are without a gap between them.");
  }
  std::size_t steps = timed.count();
  for (const Gap& gap : window.gaps) {
    steps += gap.row > timed.first && gap.row <= timed.last ? gap.missing : 0;
  }
  if (auto status = settle_rate(spec, unit, span / static_cast<double>(steps), window); !status) {
    return fail(status.error());
  }
  note_irregularities({first, last}, *time, window);
  return window;
}

}  // namespace

Result<Window> plan_window(const RecordingSpec& spec, std::size_t rows, std::span<const double> time_column,
                           const Unit& time_unit) {
  assert(time_column.empty() || time_column.size() == rows);
  if (auto status = check_settings(spec); !status) {
    return fail(status.error());
  }
  if (rows < 2) {
    return fail(ErrorCode::TooFewSamples,
                "The recording has " + with_count(rows, "sample") + "; at least two are needed.");
  }
  return time_column.empty() ? plan_uniform(spec, rows) : plan_stamped(spec, time_column, time_unit);
}

}  // namespace driftlab
