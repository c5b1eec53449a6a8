#include "core/signal/recording.hpp"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace driftlab {
namespace {

/// Stated and measured rates may differ by this much: more is another rate, not a clock error.
constexpr double kRateTolerance = 0.01;

/// Within this the stamps confirm the stated rate and 1/rate_hz is the sample interval; decimal stamps round that much.
constexpr double kRateConfirmed = 1e-6;

std::string short_text(double value) {
  char buffer[32];
  const auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 6);
  return error == std::errc{} ? std::string(buffer, end) : std::string("?");
}

Status check_settings(const RecordingSpec& spec) {
  if (spec.rate_hz && !(*spec.rate_hz > 0.0 && std::isfinite(*spec.rate_hz))) {
    return fail(ErrorCode::InvalidArgument, "The sampling rate must be a positive number of Hz.",
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
    return fail(ErrorCode::InconsistentSampling,
                "There is no time column and no stated rate: give rate_hz, or name the time column.",
                {{"parameter", "rate_hz"}});
  }
  // A sample at exactly the trim stays; the slack absorbs rounding of seconds times rate.
  const auto samples_in = [&](double seconds) {
    return std::min(std::ceil(seconds * *spec.rate_hz - 1e-6), static_cast<double>(rows));
  };
  const auto from_start = static_cast<std::size_t>(std::max(0.0, samples_in(spec.trim.start_s)));
  const auto from_end = static_cast<std::size_t>(std::max(0.0, samples_in(spec.trim.end_s)));
  if (from_start + from_end + 2 > rows) {
    return trimmed_away(spec, static_cast<double>(rows - 1) / *spec.rate_hz);
  }
  Window window;
  window.time.dt_s = 1.0 / *spec.rate_hz;
  window.first = from_start;
  window.count = rows - from_start - from_end;
  window.quality.samples = rows;
  window.quality.analysed = window.count;
  return window;
}

/// The time column in seconds, finite and never falling.
Result<std::vector<double>> checked_stamps(std::span<const double> column, const Unit& unit) {
  std::vector<double> stamps(column.size());
  for (std::size_t i = 0; i < column.size(); ++i) {
    stamps[i] = unit.to_si(column[i]);
    if (!std::isfinite(stamps[i])) {
      return fail(ErrorCode::NonFinite,
                  "Sample " + std::to_string(i + 1) + " of the time column is not a finite number.",
                  {{"row", std::to_string(i + 1)}});
    }
    if (i > 0 && stamps[i] < stamps[i - 1]) {
      return fail(ErrorCode::NonMonotonicTime,
                  "The time column steps back by " + short_text(stamps[i - 1] - stamps[i]) + " s at sample " +
                      std::to_string(i + 1) + ".",
                  {{"row", std::to_string(i + 1)}});
    }
  }
  return stamps;
}

/// Samples that share one stamp.
struct Group {
  std::size_t first = 0;
  std::size_t count = 1;
};

std::vector<Group> group_by_stamp(const std::vector<double>& stamps) {
  std::vector<Group> groups{{0, 1}};
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] == stamps[i - 1]) {
      ++groups.back().count;
    } else {
      groups.push_back({i, 1});
    }
  }
  return groups;
}

/// Median over the advancing steps of step per sample, 0 if none advances. Between groups of a and b samples lie
/// (a + b)/2 sample intervals on average, so repeated stamps (coarse clocks, FIFOs stamped at once) do not bias it.
double median_interval(const std::vector<double>& stamps, const std::vector<Group>& groups) {
  std::vector<double> intervals;
  intervals.reserve(groups.size());
  for (std::size_t g = 1; g < groups.size(); ++g) {
    const double step = stamps[groups[g].first] - stamps[groups[g - 1].first];
    intervals.push_back(step / (0.5 * static_cast<double>(groups[g - 1].count + groups[g].count)));
  }
  if (intervals.empty()) {
    return 0.0;
  }
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

/// The rows before which samples are missing: a step is a gap if it exceeds what the samples of both its groups can
/// span, a + b - 1 intervals, by more than half an interval. Without repeated stamps that is 1.5 intervals.
std::vector<std::size_t> find_gaps(const std::vector<double>& stamps, const std::vector<Group>& groups,
                                   double interval_s) {
  std::vector<std::size_t> gaps;
  for (std::size_t g = 1; g < groups.size(); ++g) {
    const double step = stamps[groups[g].first] - stamps[groups[g - 1].first];
    if (step > (static_cast<double>(groups[g - 1].count + groups[g].count) - 0.5) * interval_s) {
      gaps.push_back(groups[g].first);
    }
  }
  return gaps;
}

Quality survey(const std::vector<double>& stamps, std::size_t groups, const std::vector<std::size_t>& gaps) {
  Quality quality;
  quality.samples = stamps.size();
  quality.repeated_stamps = stamps.size() - groups;
  quality.gaps = gaps.size();
  for (const std::size_t row : gaps) {
    quality.longest_gap_s = std::max(quality.longest_gap_s, stamps[row] - stamps[row - 1]);
  }
  quality.measured_rate_hz = static_cast<double>(stamps.size() - 1) / (stamps.back() - stamps.front());
  return quality;
}

/// The longest run of rows in [first, last) without a gap; the earliest of equals.
std::pair<std::size_t, std::size_t> longest_stretch(const std::vector<std::size_t>& gaps, std::size_t first,
                                                    std::size_t last) {
  std::pair<std::size_t, std::size_t> best{first, first};
  std::size_t begin = first;
  const auto close = [&](std::size_t end) {
    if (end - begin > best.second - best.first) {
      best = {begin, end};
    }
    begin = end;
  };
  for (const std::size_t row : gaps) {
    if (row > first && row < last) {
      close(row);
    }
  }
  close(last);
  return best;
}

std::string hint_for_unit(double measured_hz, double stated_hz) {
  struct Candidate {
    const char* symbol;
    double factor;
  };
  for (const Candidate candidate : {Candidate{"ms", 1e3}, Candidate{"us", 1e6}, Candidate{"ns", 1e9}}) {
    if (std::abs(measured_hz * candidate.factor / stated_hz - 1.0) <= kRateTolerance) {
      return std::string(" In ") + candidate.symbol + " it would agree: state that unit.";
    }
  }
  return "";
}

/// Compares the rate of the analysed stretch with the stated one and settles the sample interval.
Status settle_rate(const RecordingSpec& spec, const Unit& unit, double measured_dt_s, Window& window) {
  const bool unit_known = unit.dimension == Dimension::Time;
  const double measured_hz = 1.0 / measured_dt_s;
  window.time.dt_s = measured_dt_s;
  if (!spec.rate_hz) {
    if (!unit_known) {
      return fail(ErrorCode::InconsistentSampling,
                  "The time column has no unit and no rate is stated: give its unit (s, ms, us, ns) or rate_hz.",
                  {{"parameter", "rate_hz"}});
    }
    return {};
  }
  const double difference = std::abs(measured_hz / *spec.rate_hz - 1.0);
  if (difference > kRateTolerance) {
    const std::string read_as = unit_known ? "" : ", read in seconds,";
    return fail(
        ErrorCode::InconsistentSampling,
        "The stated rate is " + short_text(*spec.rate_hz) + " Hz, but the time column" + read_as + " says " +
            short_text(measured_hz) + " Hz." + (unit_known ? "" : hint_for_unit(measured_hz, *spec.rate_hz)),
        {{"parameter", "rate_hz"}, {"stated_hz", short_text(*spec.rate_hz)}, {"measured_hz", short_text(measured_hz)}});
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

void note_irregularities(std::size_t trimmed_rows, Window& window) {
  Quality& quality = window.quality;
  if (quality.repeated_stamps > 0) {
    quality.notes.push_back(std::to_string(quality.repeated_stamps) + " time stamps repeat the one before.");
  }
  if (quality.gaps > 0) {
    quality.notes.push_back("The time column has " + std::to_string(quality.gaps) + " gaps, the longest " +
                            short_text(quality.longest_gap_s) + " s.");
  }
  if (window.count < trimmed_rows) {
    quality.notes.push_back("Only the longest stretch without a gap is analysed: " + std::to_string(window.count) +
                            " of " + std::to_string(trimmed_rows) + " samples, from sample " +
                            std::to_string(window.first + 1) + ".");
  }
}

Result<Window> plan_stamped(const RecordingSpec& spec, std::span<const double> column, const Unit& unit) {
  auto stamps = checked_stamps(column, unit);
  if (!stamps) {
    return fail(stamps.error());
  }
  const std::vector<Group> groups = group_by_stamp(*stamps);
  const double interval_s = median_interval(*stamps, groups);
  if (interval_s <= 0.0) {
    return fail(ErrorCode::InconsistentSampling, "The time column never advances.");
  }
  Window window;
  const std::vector<std::size_t> gaps = find_gaps(*stamps, groups, interval_s);
  window.quality = survey(*stamps, groups.size(), gaps);
  window.time.start_s = stamps->front();
  // Rows at exactly the trim stay; the slack absorbs the rounding of decimal stamps.
  const double slack = 1e-6 * interval_s;
  const auto begin = std::lower_bound(stamps->begin(), stamps->end(), stamps->front() + spec.trim.start_s - slack);
  const auto end = std::upper_bound(stamps->begin(), stamps->end(), stamps->back() - spec.trim.end_s + slack);
  if (end - begin < 2) {
    return trimmed_away(spec, stamps->back() - stamps->front());
  }
  const auto first = static_cast<std::size_t>(begin - stamps->begin());
  const auto last = static_cast<std::size_t>(end - stamps->begin());
  const auto [from, to] = longest_stretch(gaps, first, last);
  window.first = from;
  window.count = to - from;
  window.quality.analysed = window.count;
  const double span = (*stamps)[to - 1] - (*stamps)[from];
  if (window.count < 2 || span <= 0.0) {
    return fail(ErrorCode::TooFewSamples, "No two consecutive samples are without a gap between them.");
  }
  if (auto status = settle_rate(spec, unit, span / static_cast<double>(window.count - 1), window); !status) {
    return fail(status.error());
  }
  note_irregularities(last - first, window);
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
    return fail(ErrorCode::TooFewSamples, "The recording has " + std::to_string(rows) +
                                              (rows == 1 ? " sample" : " samples") + "; at least two are needed.");
  }
  return time_column.empty() ? plan_uniform(spec, rows) : plan_stamped(spec, time_column, time_unit);
}

}  // namespace driftlab
