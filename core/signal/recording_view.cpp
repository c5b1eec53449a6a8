#include "core/signal/recording_view.hpp"

#include <algorithm>

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
    channel.owned =
        minus_column(channel.values, unit, column(*index).subspan(window.first, window.count), reference_unit);
  } else if (spec.condition.kind == ConditionKind::ConstantAngularAcceleration &&
             channel.role.quantity == Quantity::AngularRate && channel.role.axis == spec.condition.axis &&
             unit.dimension == Dimension::AngularRate) {
    channel.owned =
        minus_ramp(channel.values, unit, spec.condition.value.value_or(0.0), window.time.dt_s, window.first);
  } else {
    return;
  }
  channel.values = channel.owned;
}

}  // namespace

Result<RecordingView> view_recording(const RecordingSpec& spec, const ColumnNames& names, std::size_t rows,
                                     const Columns& column) {
  auto roles = assign_roles(spec, names);
  if (!roles) {
    return fail(roles.error());
  }
  std::span<const double> time;
  Unit time_unit;
  for (std::size_t i = 0; i < roles->size(); ++i) {
    const std::optional<ColumnRole>& role = (*roles)[i];
    if (role && role->quantity == Quantity::Time) {
      time = column(i);
      time_unit = role->unit.value_or(Unit{});
    }
  }
  auto window = plan_window(spec, rows, time, time_unit);
  if (!window) {
    return fail(window.error());
  }
  RecordingView view;
  view.window = std::move(*window);
  for (std::size_t i = 0; i < roles->size(); ++i) {
    const auto& role = (*roles)[i];
    if (!role) {
      view.window.quality.notes.push_back("The column '" + names[i] + "' has no stated meaning and is ignored.");
      continue;
    }
    if (!is_sensor(role->quantity)) {
      continue;
    }
    if (!role->unit) {
      view.window.quality.notes.push_back("The unit of column '" + names[i] + "' is not stated; its unit is 1.");
    }
    ChannelView channel{names[i], *role, column(i).subspan(view.window.first, view.window.count), {}};
    subtract_moving_reference(channel, spec, *roles, column, view.window);
    view.channels.push_back(std::move(channel));
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
