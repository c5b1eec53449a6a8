#include "core/signal/recording_view.hpp"

#include "core/signal/channel_survey.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

namespace driftlab {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

using Columns = std::function<std::span<const double>(std::size_t)>;
using Roles = std::vector<std::optional<ColumnRole>>;

std::optional<std::size_t> find_role(const Roles& roles, Quantity quantity, const std::string& axis) {
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const std::optional<ColumnRole>& role = roles[i];
    if (role && role->quantity == quantity && role->axis == axis) {
      return i;
    }
  }
  return std::nullopt;
}

/// The column that a channel's reference comes from.
struct ReferenceSource {
  std::size_t column = 0;
  bool angle = false;  ///< an angle, whose derivative is the reference
};

std::optional<ReferenceSource> reference_of(const ColumnRole& role, const Roles& roles) {
  const bool rate = role.quantity == Quantity::AngularRate;
  if (!rate && role.quantity != Quantity::SpecificForce) {
    return std::nullopt;
  }
  const Quantity quantity = rate ? Quantity::ReferenceAngularRate : Quantity::ReferenceSpecificForce;
  if (const auto index = find_role(roles, quantity, role.axis)) {
    return ReferenceSource{*index, false};
  }
  const auto angle = rate ? find_role(roles, Quantity::ReferenceAngle, role.axis) : std::nullopt;
  return angle ? std::optional(ReferenceSource{*angle, true}) : std::nullopt;
}

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

/// The rate behind an angle column at the channel's rows, in the channel's unit: central differences, one-sided at the
/// ends of a run.
std::vector<double> rate_of_angle(const Stretch& stretch, const Unit& unit, std::span<const double> column,
                                  const Unit& angle_unit, double dt_s) {
  std::vector<double> rate;
  rate.reserve(stretch.rows());
  for (const RowRun& run : stretch.runs) {
    const std::span<const double> angle = column.subspan(run.first, run.count);
    for (std::size_t i = 0; i < run.count; ++i) {
      const std::size_t before = i == 0 ? 0 : i - 1;
      const std::size_t behind = i + 1 == run.count ? i : i + 1;
      const double steps = behind > before ? static_cast<double>(behind - before) : 1.0;
      // An encoder that starts again after a turn has not turned back.
      const double turned = std::remainder(angle_unit.to_si(angle[behind]) - angle_unit.to_si(angle[before]), kTurn);
      rate.push_back(unit.from_si(turned / (steps * dt_s)));
    }
  }
  return rate;
}

/// Time of each analysed row since the first of the file.
class RowTimes {
 public:
  explicit RowTimes(const Window& window) : window_(window) {}
  /// Rows must be asked for in rising order.
  double at(std::size_t row) {
    for (; next_ < window_.gaps.size() && window_.gaps[next_].row <= row; ++next_) {
      missing_ += window_.gaps[next_].missing;
    }
    return window_.time.first_s + window_.time.dt_s * static_cast<double>(row - window_.first + missing_);
  }

 private:
  const Window& window_;
  std::size_t next_ = 0;
  std::size_t missing_ = 0;
};

/// The ramp from rest at the first row of the file, at the channel's rows.
std::vector<double> ramp(const Stretch& stretch, const Unit& unit, double acceleration_si, const Window& window) {
  RowTimes times(window);
  std::vector<double> reference;
  reference.reserve(stretch.rows());
  for (const RowRun& run : stretch.runs) {
    for (std::size_t i = 0; i < run.count; ++i) {
      reference.push_back(unit.from_si(acceleration_si * times.at(run.first + i)));
    }
  }
  return reference;
}

/// Sets the reference of a channel where it has one that moves.
void set_moving_reference(const RecordingSpec& spec, const Roles& roles, const Columns& column,
                          const ColumnNames& names, const Window& window, ChannelView& channel) {
  const Unit unit = channel.role.unit.value_or(Unit{});
  if (const auto source = reference_of(channel.role, roles)) {
    const std::optional<ColumnRole>& role = roles[source->column];
    const Unit reference_unit = role && role->unit ? *role->unit : unit;
    const std::span<const double> samples = column(source->column);
    channel.reference = source->angle ? rate_of_angle(channel.stretch, unit, samples, reference_unit, window.time.dt_s)
                                      : reference_column(channel.stretch, unit, samples, reference_unit);
    channel.reference_column = names[source->column];
  } else if (spec.condition.kind == ConditionKind::ConstantAngularAcceleration &&
             channel.role.quantity == Quantity::AngularRate && channel.role.axis == spec.condition.axis &&
             unit.dimension == Dimension::AngularRate) {
    channel.reference = ramp(channel.stretch, unit, spec.condition.value.value_or(0.0), window);
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

bool holds_text(std::span<const double> values) {
  return !values.empty() && std::isnan(values.front()) && why_missing(values.front()).why == Missing::Text;
}

/// A column of which nobody said what it is, and whose name says nothing, may be words, a serial number or a sparse
/// sensor; so may one without a name that holds no number at all. Everything else is a sensor, whose holes are faults.
bool may_be_left_out(const ColumnRole& role, const std::string& name, std::size_t index,
                     std::span<const double> values) {
  const bool named = name != std::to_string(index);
  return role.quantity == Quantity::Unspecified &&
         (named || std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); }));
}

/// Surveys a sensor column and adds what is sound in its window as a channel.
Status add_channel(const RecordingSpec& spec, const Roles& roles, const Columns& column, const ColumnNames& names,
                   std::size_t index, ViewUse use, const Passed& passed, RecordingView& view) {
  const std::string& name = names[index];
  const std::span<const double> values = column(index);
  const ColumnRole role = roles[index].value_or(ColumnRole{});
  ChannelSurvey survey = survey_channel(name, values, passed);
  const Window& window = view.window;
  // Where the reference is missing the error is.
  if (const auto source = reference_of(role, roles)) {
    const std::span<const double> subtracted = column(source->column);
    for (std::size_t i = 0; i < subtracted.size(); ++i) {
      if (!std::isfinite(subtracted[i]) && std::isfinite(values[i])) {
        survey.unsound.push_back(i);
      }
    }
    std::sort(survey.unsound.begin(), survey.unsound.end());
    survey.unsound.erase(std::unique(survey.unsound.begin(), survey.unsound.end()), survey.unsound.end());
  }
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
    set_moving_reference(spec, roles, column, names, view.window, channel);
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

Result<RecordingView> view_recording(const RecordingSpec& spec, const ColumnNames& names, std::size_t rows,
                                     const Columns& column, ViewUse use, const Passed& passed) {
  auto roles = assign_roles(spec, names);
  if (!roles) {
    return fail(roles.error());
  }
  std::vector<std::string> notes;
  std::span<const double> time;
  Unit time_unit;
  for (std::size_t i = 0; i < roles->size(); ++i) {
    const std::optional<ColumnRole>& role = (*roles)[i];
    if (!role || role->quantity != Quantity::Time) {
      continue;
    }
    if (spec.columns.empty() && holds_text(column(i))) {
      notes.push_back("The column '" + names[i] + "' holds text and is not used as time.");
      continue;
    }
    time = column(i);
    time_unit = role->unit.value_or(Unit{});
  }
  auto window = plan_window(spec, rows, time, time_unit);
  if (!window) {
    return fail(window.error());
  }
  RecordingView view;
  view.window = std::move(*window);
  std::optional<Error> first_fault;
  view.window.quality.notes.insert(view.window.quality.notes.end(), notes.begin(), notes.end());
  for (std::size_t i = 0; i < roles->size(); ++i) {
    const auto& role = (*roles)[i];
    if (!role) {
      view.window.quality.notes.push_back("The column '" + names[i] + "' has no stated meaning and is ignored.");
      continue;
    }
    if (!is_sensor(role->quantity)) {
      continue;
    }
    if (auto holes = check_holes(names[i], column(i), passed); !holes) {
      first_fault = first_fault ? first_fault : std::optional(holes.error());
      if (spec.columns.empty() && may_be_left_out(*role, names[i], i, column(i))) {
        view.window.quality.notes.push_back("The column '" + names[i] + "' is left out: " + holes.error().message);
        continue;
      }
      return fail(holes.error());
    }
    if (!role->unit) {
      view.window.quality.notes.push_back("The unit of column '" + names[i] + "' is not stated; its unit is 1.");
    }
    // A sensor that is frozen throughout does not keep the others from being analysed.
    if (auto status = add_channel(spec, *roles, column, names, i, use, passed, view); !status) {
      first_fault = first_fault ? first_fault : std::optional(status.error());
      view.window.quality.notes.push_back(status.error().message + " It is left out.");
    }
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

}  // namespace driftlab
