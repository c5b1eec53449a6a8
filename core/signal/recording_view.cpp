#include "core/signal/recording_view.hpp"

#include "core/signal/channel_survey.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab {
namespace {

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

std::optional<Quantity> reference_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::AngularRate:
      return Quantity::ReferenceAngularRate;
    case Quantity::SpecificForce:
      return Quantity::ReferenceSpecificForce;
    default:
      return std::nullopt;
  }
}

/// Measured minus reference column, in the channel's unit.
std::vector<double> minus_column(std::span<const double> measured, const Unit& unit, std::span<const double> reference,
                                 const Unit& reference_unit) {
  std::vector<double> error(measured.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    error[i] = measured[i] - unit.from_si(reference_unit.to_si(reference[i]));
  }
  return error;
}

/// Measured minus the ramp from rest; `first` is the row of measured[0] counted from the first sample of the file.
std::vector<double> minus_ramp(std::span<const double> measured, const Unit& unit, double acceleration_si, double dt_s,
                               std::size_t first) {
  std::vector<double> error(measured.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    error[i] = measured[i] - unit.from_si(acceleration_si * dt_s * static_cast<double>(first + i));
  }
  return error;
}

void subtract_moving_reference(ChannelView& channel, const RecordingSpec& spec, const Roles& roles,
                               const Columns& column, const Window& window) {
  const Unit unit = channel.role.unit.value_or(Unit{});
  const auto reference = reference_of(channel.role.quantity);
  if (!reference) {
    return;
  }
  if (const auto index = find_role(roles, *reference, channel.role.axis)) {
    const std::optional<ColumnRole>& role = roles[*index];
    const Unit reference_unit = role && role->unit ? *role->unit : unit;
    channel.owned = minus_column(channel.values, unit, column(*index).subspan(channel.first_row, channel.values.size()),
                                 reference_unit);
  } else if (spec.condition.kind == ConditionKind::ConstantAngularAcceleration &&
             channel.role.quantity == Quantity::AngularRate && channel.role.axis == spec.condition.axis &&
             unit.dimension == Dimension::AngularRate) {
    channel.owned =
        minus_ramp(channel.values, unit, spec.condition.value.value_or(0.0), window.time.dt_s, channel.first_row);
  } else {
    return;
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

/// Surveys a sensor column and adds the sound part of its window as a channel.
Status add_channel(const RecordingSpec& spec, const Roles& roles, const Columns& column, const std::string& name,
                   std::size_t index, const Passed& passed, RecordingView& view) {
  const std::span<const double> values = column(index);
  const ColumnRole role = roles[index].value_or(ColumnRole{});
  ChannelSurvey survey = survey_channel(name, values, passed);
  const Window& window = view.window;
  // Where the reference is missing the error is.
  const auto reference = reference_of(role.quantity);
  const auto reference_index = reference ? find_role(roles, *reference, role.axis) : std::optional<std::size_t>();
  if (reference_index) {
    const std::span<const double> subtracted = column(*reference_index);
    for (std::size_t i = 0; i < subtracted.size(); ++i) {
      if (!std::isfinite(subtracted[i]) && std::isfinite(values[i])) {
        survey.unsound.push_back(i);
      }
    }
    std::sort(survey.unsound.begin(), survey.unsound.end());
    survey.unsound.erase(std::unique(survey.unsound.begin(), survey.unsound.end()), survey.unsound.end());
  }
  const auto [first, last] = longest_sound(survey, window.first, window.first + window.count);
  if (last < first + 2) {
    survey.quality.analysed = 0;
    view.window.quality.channels.push_back(survey.quality);
    return fail(ErrorCode::TooFewSamples,
                "Column '" + name + "' has no two consecutive sound samples in the analysed part.", {{"column", name}});
  }
  survey.quality.first = first + 1;
  survey.quality.analysed = last - first;
  std::string sentence = describe(survey.quality, window.count);
  if (!sentence.empty()) {
    view.window.quality.notes.push_back(std::move(sentence));
  }
  view.window.quality.channels.push_back(std::move(survey.quality));
  ChannelView channel{name, role, first, values.subspan(first, last - first), {}};
  subtract_moving_reference(channel, spec, roles, column, view.window);
  view.channels.push_back(std::move(channel));
  return {};
}

}  // namespace

Result<RecordingView> view_recording(const RecordingSpec& spec, const ColumnNames& names, std::size_t rows,
                                     const Columns& column, const Passed& passed) {
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
    if (auto status = add_channel(spec, *roles, column, names[i], i, passed, view); !status) {
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
