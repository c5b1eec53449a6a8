#include "core/navigate/drive/table.hpp"

#include "core/signal/channel_survey.hpp"
#include "core/signal/find_column.hpp"
#include "core/signal/missing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace driftlab::drive {
namespace {

constexpr double kWeekSeconds = 604800.0;
constexpr double kStepBack = 0.2;  ///< [s] and more, at a leap second

/// Moments of UTC [s since 1970] from which GPS time has been ahead by so many seconds.
constexpr std::array<std::pair<double, double>, 6> kLeaps{{{915148800.0, 13.0},
                                                           {1136073600.0, 14.0},
                                                           {1230768000.0, 15.0},
                                                           {1341100800.0, 16.0},
                                                           {1435708800.0, 17.0},
                                                           {1483228800.0, 18.0}}};

/// A column of a table.
struct ColumnPlace {
  std::size_t index = 0;
  double factor = 1.0;  ///< SI units in one of its unit
};

/// The column with that quantity; nothing where the source states none. Error: UnknownColumn.
Result<std::optional<ColumnPlace>> place_of(const Table& table, const Source& source, Quantity quantity,
                                            std::string_view axis) {
  for (const auto& [name, meaning] : source.columns) {
    if (meaning.quantity == quantity && meaning.axis == axis) {
      const auto index = find_column(table.names, name);
      return index ? Result<std::optional<ColumnPlace>>(ColumnPlace{*index, meaning.factor}) : fail(index.error());
    }
  }
  return std::optional<ColumnPlace>();
}

/// Brings UTC to GPS time. At a leap second a clock of UTC counts one second twice, 23:59:59 or the first of the new
/// day: what follows the step back is behind it. A clock that does not step back is behind it from the new day on.
void add_leap_seconds(std::vector<double>& stamps, StampFacts& facts) {
  const auto first = std::find_if(stamps.begin(), stamps.end(), [](double stamp) { return std::isfinite(stamp); });
  if (first == stamps.end()) {
    return;
  }
  facts.leap_seconds = leap_seconds_at(*first);
  const auto next = std::find_if(kLeaps.begin(), kLeaps.end(), [&](const auto& leap) { return leap.first > *first; });
  auto behind = stamps.end();
  if (next != kLeaps.end()) {
    const double new_day = next->first;
    behind = std::find_if(first, stamps.end(), [&](double stamp) { return stamp >= new_day; });
    const auto near = [&](double stamp) { return std::abs(stamp - new_day) <= 1.0 + kStepBack; };
    const auto steps_back = [&](double a, double b) {
      return near(a) && near(b) && (a - b > kStepBack || (a == new_day && b == new_day));  // of rows once a second
    };
    if (const auto at = std::adjacent_find(first, stamps.end(), steps_back); at != stamps.end()) {
      behind = at + 1;
    }
  }
  facts.leap_within = behind != stamps.end();
  const double later = facts.leap_within ? next->second : facts.leap_seconds;
  std::for_each(first, behind, [&](double& stamp) { stamp += facts.leap_seconds; });
  std::for_each(behind, stamps.end(), [&](double& stamp) { stamp += later; });
}

std::vector<double> in_si(std::vector<double> values, double factor) {
  for (double& value : values) {
    value *= factor;
  }
  return values;
}

}  // namespace

double leap_seconds_at(double unix_s) {
  double leap = 0.0;
  for (const auto& [from, seconds] : kLeaps) {
    leap = unix_s >= from ? seconds : leap;
  }
  return leap;
}

Error of_file(Error error, const std::string& file) {
  error.message = file + ": " + error.message;
  return std::move(error).with("file", file);
}

Result<std::optional<std::vector<double>>> find_quantity(const Table& table, const Source& source, Quantity quantity,
                                                         std::string_view axis) {
  return place_of(table, source, quantity, axis).map([&](const std::optional<ColumnPlace>& place) {
    return place ? std::optional(in_si(table.columns[place->index], place->factor)) : std::nullopt;
  });
}

Result<UnitChannel> find_unit_channel(const Table& table, const Source& source, Quantity quantity,
                                      std::string_view axis) {
  const auto found = place_of(table, source, quantity, axis);
  const std::optional<ColumnPlace> place = found ? *found : std::nullopt;
  if (!place) {
    return fail(found ? Error{ErrorCode::UnknownColumn,
                              "No column of " + source.file + " is " + std::string(name_of(quantity)) + " along " +
                                  std::string(axis) + ".",
                              {{"parameter", "imu.columns"}}}
                      : found.error());
  }
  const std::string& name = table.names[place->index];
  const std::vector<double>& cells = table.columns[place->index];
  const bool empty = std::none_of(cells.begin(), cells.end(), [](double cell) { return std::isfinite(cell); });
  if (const Status holds = empty ? check_holes(name, cells) : Status(); !holds) {
    return fail(of_file(holds.error(), source.file));
  }
  const ChannelSurvey survey = survey_channel(name, cells);
  UnitChannel channel{in_si(cells, place->factor), survey.quality};
  for (const std::size_t row : survey.unsound) {
    channel.values[row] = std::numeric_limits<double>::quiet_NaN();
  }
  return channel;
}

Result<StampedRows> stamp_rows(const Table& table, const TimeMeaning& meaning) {
  StampedRows stamped;
  stamped.facts.rows = table.rows();
  std::vector<double> stamps(table.rows());
  if (meaning.scale == TimeScale::Row) {
    if (!meaning.rate_hz || !is_sampling_rate(*meaning.rate_hz)) {
      return fail(ErrorCode::InvalidArgument, "Rows without a clock need the rate_hz at which they were taken.",
                  {{"parameter", "time.rate_hz"}});
    }
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      stamps[i] = static_cast<double>(i) / *meaning.rate_hz;
    }
  } else {
    const auto column = find_column(table.names, meaning.column);
    if (!column) {
      return fail(column.error());
    }
    // A stream that stands beside a longer one has ended before the table does.
    const std::vector<double>& values = table.columns[*column];
    const auto ended = [](double value) { return std::isnan(value) && why_missing(value).why == Missing::Ended; };
    while (!stamps.empty() && ended(values[stamps.size() - 1])) {
      stamps.pop_back();
    }
    std::transform(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(stamps.size()), stamps.begin(),
                   [&](double value) { return value * meaning.unit_s; });
    stamped.facts.rows = stamps.size();
  }
  if (meaning.scale == TimeScale::Utc || meaning.scale == TimeScale::Unix) {
    add_leap_seconds(stamps, stamped.facts);
    stamped.absolute = true;
  }
  double rolled = 0.0;
  double before = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (!std::isfinite(stamps[i])) {
      ++stamped.facts.without_stamp;
      continue;
    }
    double time_s = stamps[i] + rolled;
    const bool week = meaning.scale == TimeScale::Gps && stamps[i] >= 0.0 && stamps[i] < kWeekSeconds;
    if (week && time_s < before - 0.5 * kWeekSeconds) {
      rolled += kWeekSeconds;
      time_s += kWeekSeconds;
      ++stamped.facts.week_rollovers;
    }
    if (time_s < before) {
      ++stamped.facts.backward;
      continue;
    }
    before = time_s;
    stamped.row.push_back(i);
    stamped.time_s.push_back(time_s);
  }
  if (stamped.facts.backward * 100 > stamps.size()) {
    return fail(ErrorCode::NonMonotonicTime, "The stamps step back in " + std::to_string(stamped.facts.backward) +
                                                 " of " + std::to_string(stamps.size()) +
                                                 " rows; sort the file by time.");
  }
  if (stamped.time_s.size() < 2) {
    return fail(ErrorCode::TooFewSamples, "The file has fewer than two rows with a time.");
  }
  stamped.absolute = stamped.absolute || meaning.scale == TimeScale::Gps;
  if (table.tag) {  // the file's own clock runs linearly from the first date to the last (RTKLIB time tag)
    const double first = stamped.time_s.front();
    const double scale = (table.tag->last_s - table.tag->first_s) / std::max(stamped.time_s.back() - first, 1e-9);
    for (double& time_s : stamped.time_s) {
      time_s = table.tag->first_s + scale * (time_s - first);
    }
    stamped.absolute = true;
  }
  for (double& time_s : stamped.time_s) {
    time_s += meaning.offset_s;
  }
  return stamped;
}

}  // namespace driftlab::drive
