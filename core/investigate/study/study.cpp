#include "core/investigate/study/study.hpp"

#include "core/investigate/study/time_grid.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

using Roles = std::vector<std::optional<ColumnRole>>;
using Columns = std::function<std::span<const double>(std::size_t)>;

std::optional<std::size_t> find_role(const Roles& roles, Quantity quantity, std::string_view axis) {
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const auto& role = roles[i];
    if (role && role->quantity == quantity && (axis.empty() || role->axis == axis)) {
      return i;
    }
  }
  return std::nullopt;
}

/// The stated unit of a column, else `otherwise`.
Unit unit_of(const Roles& roles, std::size_t column, const Unit& otherwise = {}) {
  const auto& role = roles[column];
  return role && role->unit ? *role->unit : otherwise;
}

/// Rows put on the grid; places between rows are interpolated.
std::vector<double> on_grid(std::span<const double> rows, const Unit& unit, const TimeGrid& grid) {
  std::vector<double> values(grid.length);
  if (grid.place.empty()) {
    std::transform(rows.begin(), rows.end(), values.begin(), [&](double v) { return unit.to_si(v); });
    return values;
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    values[grid.place[i]] = unit.to_si(rows[i]);
    if (i > 0) {
      const std::size_t from = grid.place[i - 1];
      const std::size_t to = grid.place[i];
      for (std::size_t g = from + 1; g < to; ++g) {
        const double share = static_cast<double>(g - from) / static_cast<double>(to - from);
        values[g] = values[from] + share * (values[to] - values[from]);
      }
    }
  }
  return values;
}

std::vector<double> derivative(const std::vector<double>& x, double dt_s) {
  std::vector<double> d(x.size(), 0.0);
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    d[i] = i == 0 ? (x[1] - x[0]) / dt_s : (x[i + 1] - x[i - 1]) / (2.0 * dt_s);
  }
  if (x.size() > 1) {
    d.back() = (x.back() - x[x.size() - 2]) / dt_s;
  }
  return d;
}

/// The reference rate about each axis, from columns or from the condition; nothing for free motion without a column.
void set_rotation(StudyRecording& recording, const Roles& roles, const Columns& column, const TimeGrid& grid) {
  bool from_column = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string axis(1, static_cast<char>('x' + k));
    if (const auto index = find_role(roles, Quantity::ReferenceAngularRate, axis)) {
      recording.rate[k] = on_grid(column(*index), unit_of(roles, *index), grid);
      from_column = true;
    } else if (const auto turn = find_role(roles, Quantity::ReferenceAngle, axis)) {
      recording.rate[k] = derivative(on_grid(column(*turn), unit_of(roles, *turn), grid), grid.dt_s);
      from_column = true;
    }
  }
  const Condition& condition = recording.condition;
  const bool free_motion = condition.kind == ConditionKind::Profile || condition.kind == ConditionKind::Drive;
  if (free_motion && !from_column) {
    return;
  }
  const auto turning = axis_index(condition.axis);
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double>& rate = recording.rate[k];
    if (!rate.empty()) {
      recording.acceleration[k] = derivative(rate, recording.dt_s);
      continue;
    }
    rate.assign(recording.length, 0.0);
    recording.acceleration[k].assign(recording.length, 0.0);
    if (turning != k || !condition.value) {
      continue;
    }
    if (condition.kind == ConditionKind::ConstantRate) {
      std::fill(rate.begin(), rate.end(), *condition.value);
    } else if (condition.kind == ConditionKind::ConstantAngularAcceleration) {
      std::fill(recording.acceleration[k].begin(), recording.acceleration[k].end(), *condition.value);
      for (std::size_t i = 0; i < rate.size(); ++i) {
        rate[i] = *condition.value * recording.time_s(i);
      }
    }
  }
  // The angle is that about the axis that turns most.
  std::size_t main = 2;
  double most = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0.0;
    for (const double w : recording.rate[k]) {
      sum += std::fabs(w);
    }
    if (sum > most) {
      most = sum;
      main = k;
    }
  }
  if (most > 0.0) {
    recording.angle.assign(recording.length, 0.0);
    for (std::size_t i = 1; i < recording.length; ++i) {
      recording.angle[i] =
          recording.angle[i - 1] + 0.5 * recording.dt_s * (recording.rate[main][i - 1] + recording.rate[main][i]);
    }
  }
}

/// The reference of a channel: a column, or what the condition says. Sets `error` where there is one.
void set_error(StudyRecording& recording, Channel& channel, const Roles& roles, const Columns& column,
               const TimeGrid& grid) {
  const Condition& condition = recording.condition;
  const auto axis = axis_index(channel.role.axis);
  channel.error = channel.measured;
  if (channel.role.quantity == Quantity::AngularRate && axis && channel.unit.dimension == Dimension::AngularRate) {
    if (recording.rate[*axis].empty()) {
      channel.error.clear();
      return;
    }
    channel.reference = recording.rate[*axis];
  } else if (channel.role.quantity == Quantity::SpecificForce) {
    if (const auto index = find_role(roles, Quantity::ReferenceSpecificForce, channel.role.axis)) {
      channel.reference = on_grid(column(*index), unit_of(roles, *index), grid);
    } else if (condition.kind == ConditionKind::SixPosition && condition.up && condition.axis == channel.role.axis) {
      channel.reference.assign(recording.length, *condition.up ? kStandardGravity : -kStandardGravity);
      channel.input_only = true;  // until settle_channels knows whether a gyro is there
    } else {
      channel.input_only = true;
      if (condition.kind == ConditionKind::Drive || condition.kind == ConditionKind::Profile) {
        channel.error.clear();
      }
      return;
    }
  }
  for (std::size_t i = 0; i < channel.reference.size(); ++i) {
    channel.error[i] -= channel.reference[i];
  }
}

Result<TimeGrid> grid_of(const RecordingSpec& spec, std::size_t rows, const Roles& roles, const Columns& column) {
  if (rows < 16) {
    return fail(ErrorCode::TooFewSamples,
                "The recording has " + std::to_string(rows) + " samples; an investigation needs at least 16.");
  }
  if (const auto index = find_role(roles, Quantity::Time, "")) {
    const Unit unit = unit_of(roles, *index, Unit{"s", Dimension::Time});
    const std::span<const double> values = column(*index);
    std::vector<double> stamps(values.size());
    std::transform(values.begin(), values.end(), stamps.begin(),
                   [&](double v) { return unit.to_si(v) - unit.to_si(values[0]); });
    auto grid = fit_time_grid(stamps, spec.rate_hz);
    if (grid && spec.rate_hz && std::fabs(grid->dt_s * *spec.rate_hz - 1.0) > 0.01) {
      return fail(ErrorCode::InconsistentSampling, "The stated rate and the time column contradict each other.",
                  {{"parameter", "rate_hz"}});
    }
    return grid;
  }
  if (!spec.rate_hz) {
    return fail(ErrorCode::InconsistentSampling,
                "There is no time column and no stated rate: give rate_hz, or name the time column.",
                {{"parameter", "rate_hz"}});
  }
  TimeGrid grid;
  grid.dt_s = 1.0 / *spec.rate_hz;
  grid.length = rows;
  return grid;
}

Status set_window(StudyRecording& recording, const Trim& trim) {
  const auto samples = [&](double seconds) {
    return static_cast<std::size_t>(
        std::min(std::ceil(seconds / recording.dt_s - 1e-6), static_cast<double>(recording.length)));
  };
  const std::size_t from_start = samples(std::max(0.0, trim.start_s));
  const std::size_t from_end = samples(std::max(0.0, trim.end_s));
  if (from_start + from_end + 16 > recording.length) {
    return fail(ErrorCode::TooFewSamples, "The trims leave fewer than 16 samples of the recording.");
  }
  recording.begin = from_start;
  recording.end = recording.length - from_end;
  return {};
}

}  // namespace

std::optional<std::size_t> axis_index(std::string_view axis) {
  if (axis.size() == 1 && axis[0] >= 'x' && axis[0] <= 'z') {
    return static_cast<std::size_t>(axis[0] - 'x');
  }
  return std::nullopt;
}

Result<StudyRecording> make_study_recording(const RecordingSpec& spec, const ColumnNames& names, std::size_t rows,
                                            const Columns& column) {
  auto roles = assign_roles(spec, names);
  if (!roles) {
    return fail(roles.error());
  }
  auto grid = grid_of(spec, rows, *roles, column);
  if (!grid) {
    return fail(grid.error());
  }
  StudyRecording recording;
  recording.id = spec.id;
  recording.condition = spec.condition;
  recording.dt_s = grid->dt_s;
  recording.length = grid->length;
  recording.stamps = grid->stamps;
  if (auto status = set_window(recording, spec.trim); !status) {
    return fail(status.error());
  }
  if (!spec.calibration.empty()) {
    recording.notes.push_back("Its calibration '" + spec.calibration +
                              "' is not applied: what is examined are the readings as the sensor gave them.");
  }
  set_rotation(recording, *roles, column, *grid);
  if (const auto index = find_role(*roles, Quantity::Temperature, "")) {
    recording.temperature = on_grid(column(*index), unit_of(*roles, *index), *grid);
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto& role = (*roles)[i];
    if (!role) {
      recording.notes.push_back("The column '" + names[i] + "' has no stated meaning and is ignored.");
      continue;
    }
    if (!is_sensor(role->quantity)) {
      continue;
    }
    Channel channel;
    channel.column = names[i];
    channel.role = *role;
    channel.unit = role->unit.value_or(Unit{});
    if (!role->unit) {
      recording.notes.push_back("The unit of column '" + names[i] + "' is not stated; its unit is 1.");
    }
    channel.rows = column(i);
    for (std::size_t row = 0; row < channel.rows.size(); ++row) {
      if (!std::isfinite(channel.rows[row])) {
        return fail(ErrorCode::NonFinite, "The column '" + names[i] + "' holds a value that is not a finite number.",
                    {{"column", names[i]}, {"row", std::to_string(row + 1)}});
      }
    }
    channel.measured = on_grid(channel.rows, channel.unit, *grid);
    channel.valid.assign(grid->length, grid->place.empty() ? 1 : 0);
    for (const std::size_t place : grid->place) {
      channel.valid[place] = 1;
    }
    const auto axis = axis_index(role->axis);
    if (role->quantity == Quantity::SpecificForce && axis) {
      recording.force[*axis] = channel.measured;
    }
    set_error(recording, channel, *roles, column, *grid);
    recording.channels.push_back(std::move(channel));
  }
  return recording;
}

void settle_channels(Study& study) {
  bool gyro = false;
  for (const StudyRecording& recording : study.recordings) {
    for (const Channel& channel : recording.channels) {
      gyro = gyro || channel.role.quantity == Quantity::AngularRate;
    }
  }
  for (StudyRecording& recording : study.recordings) {
    for (Channel& channel : recording.channels) {
      channel.input_only = channel.input_only && gyro;
    }
  }
}

std::vector<ChannelGroup> group_channels(const Study& study) {
  std::vector<ChannelGroup> groups;
  for (const StudyRecording& recording : study.recordings) {
    for (const Channel& channel : recording.channels) {
      if (channel.error.empty() || channel.input_only) {
        continue;
      }
      auto group = std::find_if(groups.begin(), groups.end(), [&](const ChannelGroup& g) {
        return g.role.quantity == channel.role.quantity && g.role.axis == channel.role.axis &&
               (!channel.role.axis.empty() || g.column == channel.column);
      });
      if (group == groups.end()) {
        groups.push_back({channel.column, channel.role, channel.unit, {}});
        group = groups.end() - 1;
      }
      group->members.push_back({&recording, &channel});
    }
  }
  return groups;
}

}  // namespace driftlab::investigate
