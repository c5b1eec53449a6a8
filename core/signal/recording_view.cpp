#include "core/signal/recording_view.hpp"

#include "core/signal/channel_survey.hpp"
#include "core/signal/left_out.hpp"
#include "core/signal/no_rate.hpp"
#include "core/signal/recording_columns.hpp"
#include "core/signal/repeated_rows.hpp"
#include "core/signal/row_times.hpp"
#include "core/signal/turns.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>
#include <utility>

namespace driftlab {
namespace {

/// The reference column at the channel's rows, in the channel's unit.
std::vector<double> reference_column(const Stretch& stretch, const Unit& unit, std::span<const double> column,
                                     const Unit& column_unit) {
  std::vector<double> reference;
  reference.reserve(stretch.rows());
  for (const RowRun& run : stretch.runs) {
    for (const double value : column.subspan(run.first, run.count)) {
      reference.push_back(unit.from_si(column_unit.to_si(value)));
    }
  }
  return reference;
}

/// The rate behind an angle column at the channel's rows, in the channel's unit, run by run.
std::vector<double> rate_behind(const Stretch& stretch, const Unit& unit, std::span<const double> column,
                                const Unit& angle_unit, double dt_s) {
  std::vector<double> reference;
  reference.reserve(stretch.rows());
  for (const RowRun& run : stretch.runs) {
    std::vector<double> angles;
    angles.reserve(run.count);
    for (const double angle : column.subspan(run.first, run.count)) {
      angles.push_back(angle_unit.to_si(angle));
    }
    for (const double rate : rate_of_angle(angles, dt_s)) {
      reference.push_back(unit.from_si(rate));
    }
  }
  return reference;
}

/// The ramp from rest at the first row of the file, at the channel's rows.
std::vector<double> ramp(const Stretch& stretch, const Unit& unit, const Condition& condition, const Window& window) {
  RowTimes times(window);
  std::vector<double> reference;
  reference.reserve(stretch.rows());
  for (const RowRun& run : stretch.runs) {
    for (std::size_t i = 0; i < run.count; ++i) {
      reference.push_back(unit.from_si(stated_rate(condition, condition.axis, times.at(run.first + i))));
    }
  }
  return reference;
}

/// Sets the reference of a channel where it has one that moves.
void set_moving_reference(const RecordingSpec& spec, const RecordingColumns& columns, const Window& window,
                          ChannelView& channel) {
  const Unit unit = channel.role.unit.value_or(Unit{});
  if (const auto source = columns.reference_of(channel.role.quantity, channel.role.axis)) {
    const Unit reference_unit = columns.unit(source->index, unit);
    const std::span<const double> samples = columns.samples(source->index);
    channel.reference = source->angle ? rate_behind(channel.stretch, unit, samples, reference_unit, window.time.dt_s)
                                      : reference_column(channel.stretch, unit, samples, reference_unit);
    channel.reference_column = columns.name(source->index);
  } else if (spec.condition.kind == ConditionKind::ConstantAngularAcceleration &&
             channel.role.quantity == Quantity::AngularRate && channel.role.axis == spec.condition.axis &&
             unit.dimension == Dimension::AngularRate) {
    channel.reference = ramp(channel.stretch, unit, spec.condition, window);
  }
}

/// Points `values` at the channel's rows of the file: where they lie if they are consecutive, else a copy. Subtracts
/// the reference.
void take_values(std::span<const double> column, ChannelView& channel) {
  const std::vector<RowRun>& runs = channel.stretch.runs;
  const std::size_t first = runs.front().first;
  const bool consecutive = runs.back().first + runs.back().count - first == channel.stretch.rows();
  if (consecutive && channel.reference.empty()) {
    channel.values = column.subspan(first, channel.stretch.rows());
    return;
  }
  channel.owned.reserve(channel.stretch.rows());
  for (const RowRun& run : runs) {
    const auto rows = column.subspan(run.first, run.count);
    channel.owned.insert(channel.owned.end(), rows.begin(), rows.end());
  }
  for (std::size_t i = 0; i < channel.reference.size(); ++i) {
    channel.owned[i] -= channel.reference[i];
  }
  channel.values = channel.owned;
}

/// Surveys a sensor column and adds what is sound in its window as a channel.
Status add_channel(const RecordingSpec& spec, const RecordingColumns& columns, std::size_t index, ViewUse use,
                   const Passed& passed, RecordingView& view) {
  const std::string& name = columns.name(index);
  const std::span<const double> values = columns.samples(index);
  const ColumnRole role = columns.role(index).value_or(ColumnRole{});
  ChannelSurvey survey = columns.survey(index, passed);
  const Window& window = view.window;
  const std::vector<RowRun> runs = cut_at_gaps(window.first, window.first + window.count, window.gaps);
  ChannelView channel{name, role, choose_stretch(without_rows(runs, survey.unsound, survey.frozen)), {}, {}, {},
                      {},   {}};
  if (channel.stretch.longest().count < 2) {
    survey.quality.analysed = 0;
    view.window.quality.channels.push_back(survey.quality);
    return fail(ErrorCode::TooFewSamples,
                "Column '" + name + "' has no two consecutive sound samples in the analysed part.", {{"column", name}});
  }
  channel.gaps = channel.stretch.gaps();
  survey.quality.first = channel.stretch.runs.front().first + 1;
  survey.quality.last = channel.stretch.runs.back().first + channel.stretch.runs.back().count;
  survey.quality.analysed = channel.stretch.rows();
  std::string sentence = describe(survey.quality, window.count);
  if (!sentence.empty()) {
    view.window.quality.notes.push_back(std::move(sentence));
  }
  view.window.quality.channels.push_back(std::move(survey.quality));
  if (use == ViewUse::Analysis) {
    set_moving_reference(spec, columns, view.window, channel);
    take_values(values, channel);
  }
  view.channels.push_back(std::move(channel));
  return {};
}

}  // namespace

std::span<const double> ChannelView::rows(std::size_t first, std::size_t count) const {
  std::size_t before = 0;
  for (const RowRun& run : stretch.runs) {
    if (first >= run.first && first + count <= run.first + run.count) {
      return values.subspan(before + first - run.first, count);
    }
    before += run.count;
  }
  assert(false && "the rows of a channel that are asked for must lie in one run");
  return {};
}

std::pair<std::size_t, std::size_t> longest_shared_run(std::span<const ChannelView* const> channels) {
  if (channels.empty()) {
    return {0, 0};
  }
  std::vector<RowRun> shared = channels.front()->stretch.runs;
  for (const ChannelView* const channel : channels.subspan(1)) {
    shared = shared_runs(shared, channel->stretch.runs);
  }
  const RowRun longest = Stretch{std::move(shared)}.longest();
  return {longest.first, longest.count};
}

namespace {

/// The view of columns in which no row repeats the one before.
Result<RecordingView> view_rows(const RecordingSpec& spec, const RecordingColumns& columns, std::size_t rows,
                                ViewUse use, const Passed& passed) {
  const auto time = columns.time();
  if (!time && !spec.rate_hz) {
    return neither_time_nor_rate(columns.guessed_time(), columns.time_of_text());
  }
  if (time && columns.unit(*time).dimension != Dimension::Time && !spec.rate_hz) {
    return time_without_unit(columns.name(*time), columns.guessed_time());
  }
  auto window = plan_window(spec, rows, time ? columns.samples(*time) : std::span<const double>(),
                            time ? columns.unit(*time) : Unit{});
  if (!window) {
    return fail(window.error());
  }
  RecordingView view;
  view.window = std::move(*window);
  std::vector<std::string>& notes = view.window.quality.notes;
  std::optional<Error> first_fault;
  if (std::string note = columns.note_of_time(); !note.empty()) {
    notes.push_back(std::move(note));
  }
  for (std::size_t i = 0; i < columns.count(); ++i) {
    auto use_of_column = columns.use_of(i, passed);
    if (!use_of_column) {
      return fail(use_of_column.error());
    }
    if (use_of_column->fault && !first_fault) {
      first_fault = std::move(use_of_column->fault);
    }
    if (!use_of_column->note.empty()) {
      notes.push_back(std::move(use_of_column->note));
    }
    if (!use_of_column->examined) {
      continue;
    }
    // A sensor that is frozen throughout does not keep the others from being analysed.
    if (auto status = add_channel(spec, columns, i, use, passed, view); !status) {
      first_fault = first_fault ? first_fault : std::optional(status.error());
      notes.push_back(status.error().message + " It is left out.");
    }
  }
  if (std::string skipped = columns.note_of_skipped(); !skipped.empty()) {
    notes.push_back(std::move(skipped));
  }
  if (view.channels.empty() && first_fault) {
    return fail(std::move(*first_fault));
  }
  if (view.channels.empty()) {
    return fail(
        ErrorCode::UnknownColumn,
        "None of the columns is a sensor (angular_rate or specific_force), so there is nothing to characterise.",
        {{"parameter", "columns"}});
  }
  return view;
}

}  // namespace

Result<RecordingView> view_recording(const RecordingSpec& spec, const ColumnNames& names, std::size_t rows,
                                     const RecordingColumns::Samples& column, ViewUse use, const Passed& passed) {
  auto read = RecordingColumns::read(spec, names, column);
  if (!read) {
    return fail(read.error());
  }
  if (use == ViewUse::Analysis && read->are_fixes()) {
    return fail(ErrorCode::UnknownColumn,
                "These are a receiver's fixes, whose scatter is no noise of an inertial sensor: name the file as the "
                "`gnss` of a drive (`driftlab drive draft IMU --gnss FILE`), or state in `columns` what to analyse.",
                {{"parameter", "columns"}});
  }
  const auto time = read->time();
  const std::vector<std::size_t> repeated =
      time ? repeated_rows(read->samples(*time), read->count(), column) : std::vector<std::size_t>();
  if (repeated.empty()) {
    return view_rows(spec, *read, rows, use, passed);
  }
  std::vector<std::vector<double>> distinct(names.size());
  const auto column_without = [&](std::size_t i) -> std::span<const double> {
    if (distinct[i].empty()) {
      distinct[i] = without(column(i), std::span<const std::size_t>(repeated));
    }
    return distinct[i];
  };
  read = RecordingColumns::read(spec, names, column_without);
  if (!read) {
    return fail(read.error());
  }
  auto view = view_rows(spec, *read, rows - repeated.size(), use, {});
  if (view) {
    Quality& quality = view->window.quality;
    quality.repeated_rows = repeated.size();
    quality.notes.insert(
        quality.notes.begin(),
        std::to_string(repeated.size()) + " of " + with_count(rows, "row") +
            (repeated.size() == 1
                 ? " repeats the row before, stamp and values; it is one sample written twice and does not count."
                 : " repeat the row before, stamp and values; they are one sample written twice and do not count."));
    view->distinct = std::move(distinct);
  }
  return view;
}

}  // namespace driftlab
