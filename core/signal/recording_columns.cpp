#include "core/signal/recording_columns.hpp"

#include "core/signal/missing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab {
namespace {

bool holds_text(std::span<const double> values) {
  return !values.empty() && std::isnan(values.front()) && why_missing(values.front()).why == Missing::Text;
}

}  // namespace

std::optional<std::size_t> axis_index(std::string_view axis) {
  if (axis.size() == 1 && axis[0] >= 'x' && axis[0] <= 'z') {
    return static_cast<std::size_t>(axis[0] - 'x');
  }
  return std::nullopt;
}

RecordingColumns::RecordingColumns(ColumnNames names, std::vector<std::optional<ColumnRole>> roles, Samples column,
                                   bool guessed, bool time_stated)
    : names_(std::move(names)),
      roles_(std::move(roles)),
      column_(std::move(column)),
      guessed_(guessed),
      time_stated_(time_stated) {}

Result<RecordingColumns> RecordingColumns::read(const RecordingSpec& spec, const ColumnNames& names, Samples column) {
  auto roles = assign_roles(spec, names);
  if (!roles) {
    return fail(roles.error());
  }
  const bool time_stated = std::any_of(spec.columns.begin(), spec.columns.end(),
                                       [](const auto& stated) { return stated.second.quantity == Quantity::Time; });
  return RecordingColumns(names, std::move(*roles), std::move(column), spec.columns.empty(), time_stated);
}

Unit RecordingColumns::unit(std::size_t index, const Unit& otherwise) const {
  const std::optional<ColumnRole>& role = roles_[index];
  return role && role->unit ? *role->unit : otherwise;
}

std::vector<double> RecordingColumns::si(std::size_t index, const Unit& otherwise) const {
  const std::span<const double> rows = samples(index);
  const Unit own = unit(index, otherwise);
  std::vector<double> values(rows.size());
  std::transform(rows.begin(), rows.end(), values.begin(), [&](double v) { return own.to_si(v); });
  return values;
}

std::optional<std::size_t> RecordingColumns::find(Quantity quantity, std::string_view axis) const {
  const auto found = std::find_if(roles_.begin(), roles_.end(), [&](const std::optional<ColumnRole>& role) {
    return role && role->quantity == quantity && role->axis == axis;
  });
  return found == roles_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - roles_.begin()));
}

std::optional<std::size_t> RecordingColumns::time() const {
  const auto index = find(Quantity::Time);
  return index && !time_stated_ && holds_text(samples(*index)) ? std::nullopt : index;
}

std::optional<ReferenceColumn> RecordingColumns::reference_of(Quantity sensor, std::string_view axis) const {
  const bool rate = sensor == Quantity::AngularRate;
  if (!rate && sensor != Quantity::SpecificForce) {
    return std::nullopt;
  }
  if (const auto index = find(rate ? Quantity::ReferenceAngularRate : Quantity::ReferenceSpecificForce, axis)) {
    return ReferenceColumn{*index, false};
  }
  const auto angle = rate ? find(Quantity::ReferenceAngle, axis) : std::nullopt;
  return angle ? std::optional(ReferenceColumn{*angle, true}) : std::nullopt;
}

std::string RecordingColumns::note_of_time() const {
  const auto index = find(Quantity::Time);
  if (index && !time()) {
    return "The column '" + name(*index) + "' holds text and is not used as time.";
  }
  return index && !guessed_ && !time_stated_
             ? "No column is stated to be the time; '" + name(*index) + "' is taken for it by its name."
             : "";
}

std::string RecordingColumns::note_of_unnamed(std::size_t index) const {
  return "The column '" + name(index) + "' has no stated meaning and is ignored.";
}

double stated_rate(const Condition& condition, std::string_view axis, double time_s) {
  if (condition.axis != axis || !condition.value) {
    return 0.0;
  }
  switch (condition.kind) {
    case ConditionKind::ConstantRate:
      return *condition.value;
    case ConditionKind::ConstantAngularAcceleration:
      return *condition.value * time_s;
    default:
      return 0.0;
  }
}

}  // namespace driftlab
