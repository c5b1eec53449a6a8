#include "core/investigate/study/study.hpp"

#include "core/investigate/study/sound_columns.hpp"
#include "core/investigate/study/time_grid.hpp"
#include "core/signal/kept_rows.hpp"
#include "core/signal/no_rate.hpp"
#include "core/signal/number.hpp"
#include "core/signal/recording_columns.hpp"
#include "core/signal/turns.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr std::array<std::string_view, 3> kAxes{"x", "y", "z"};

/// Below it there is nothing to examine: the least that a recording must hold after its trims.
constexpr std::size_t kFewestOnGrid = 16;

/// Values of the file's rows put on the grid; places between rows are interpolated, those before the first and behind
/// the last are as it.
std::vector<double> on_grid(std::vector<double> rows, const TimeGrid& grid) {
  if (grid.place.empty()) {
    return rows;
  }
  std::vector<double> values(grid.length, rows.back());
  std::fill_n(values.begin(), grid.place.front(), rows.front());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    values[grid.place[i]] = rows[i];
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

/// A column on the grid [SI]. Where every row has its place it stays in the file.
Series column_on_grid(const RecordingColumns& columns, std::size_t index, const TimeGrid& grid) {
  return grid.place.empty() ? Series::column(columns.samples(index), columns.unit(index))
                            : Series(on_grid(columns.si(index), grid));
}

/// A reference column on the grid [SI]; of an angle the rate behind it.
Series reference_on_grid(const RecordingColumns& columns, const ReferenceColumn& source, const TimeGrid& grid) {
  if (!source.angle) {
    return column_on_grid(columns, source.index, grid);
  }
  return rate_of_angle(on_grid(continuous_angle(columns.si(source.index), grid.place), grid), grid.dt_s);
}

/// Integral of a rate by trapezia.
std::vector<double> integral_of(const Series& rate, double dt_s) {
  std::vector<double> angle(rate.size(), 0.0);
  for (std::size_t i = 1; i < angle.size(); ++i) {
    angle[i] = angle[i - 1] + 0.5 * dt_s * (rate[i - 1] + rate[i]);
  }
  return angle;
}

/// The reference rate about each axis, from columns or from the condition; nothing for free motion without a column.
void set_rotation(StudyRecording& recording, const RecordingColumns& columns, const TimeGrid& grid) {
  bool from_column = false;
  for (std::size_t k = 0; k < 3; ++k) {
    if (const auto source = columns.reference_of(Quantity::AngularRate, kAxes[k])) {
      recording.rate[k] = reference_on_grid(columns, *source, grid);
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
    Series& rate = recording.rate[k];
    if (!rate.empty()) {
      recording.acceleration[k] = slope(rate.values(), recording.dt_s);
      continue;
    }
    rate = recording.acceleration[k] = Series::constant(0.0, recording.length);
    if (turning != k || !condition.value) {
      continue;
    }
    rate = Series::constant(stated_rate(condition, condition.axis, 0.0), recording.length);
    if (condition.kind == ConditionKind::ConstantAngularAcceleration) {
      std::vector<double> ramp(recording.length);
      for (std::size_t i = 0; i < ramp.size(); ++i) {
        ramp[i] = stated_rate(condition, condition.axis, recording.time_s(i));
      }
      rate = std::move(ramp);
      recording.acceleration[k] = Series::constant(*condition.value, recording.length);
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
    recording.angle = integral_of(recording.rate[main], recording.dt_s);
  }
}

/// The reference of a channel: a column, or what the condition says. Sets `error` where there is one.
void set_error(StudyRecording& recording, Channel& channel, const RecordingColumns& columns, const TimeGrid& grid) {
  const Condition& condition = recording.condition;
  const auto axis = axis_index(channel.role.axis);
  channel.error = channel.measured;
  if (channel.role.quantity == Quantity::AngularRate && axis && channel.unit.dimension == Dimension::AngularRate) {
    if (recording.rate[*axis].empty()) {
      channel.error = {};
      return;
    }
    channel.reference = recording.rate[*axis];
  } else if (channel.role.quantity == Quantity::SpecificForce) {
    if (const auto source = columns.reference_of(channel.role.quantity, channel.role.axis)) {
      channel.reference = reference_on_grid(columns, *source, grid);
    } else if (condition.kind == ConditionKind::SixPosition && condition.up && condition.axis == channel.role.axis) {
      channel.reference = Series::constant(*condition.up ? kStandardGravity : -kStandardGravity, recording.length);
      channel.input_only = true;  // until settle_channels knows whether a gyro is there
    } else {
      channel.input_only = true;
      if (condition.kind == ConditionKind::Drive || condition.kind == ConditionKind::Profile) {
        channel.error = {};
      }
      return;
    }
  }
  channel.error = channel.against_reference();
}

/// Which places of the grid hold a row.
Presence presence_of(const TimeGrid& grid) {
  if (grid.place.empty()) {
    return Presence(grid.length);
  }
  std::vector<unsigned char> places(grid.length, 0);
  for (const std::size_t place : grid.place) {
    places[place] = 1;
  }
  return Presence(std::move(places));
}

Result<TimeGrid> grid_of(const RecordingSpec& spec, std::size_t rows, const RecordingColumns& columns) {
  if (rows < kFewestOnGrid) {
    return fail(ErrorCode::TooFewSamples,
                "The recording has " + with_count(rows, "sample") + "; an investigation needs at least 16.");
  }
  if (const auto index = columns.time()) {
    const bool unit_known = columns.unit(*index).dimension == Dimension::Time;
    if (!unit_known && !spec.rate_hz) {
      return time_without_unit(columns.name(*index), columns.guessed_time());
    }
    std::vector<double> stamps = columns.si(*index, Unit{"s", Dimension::Time});
    const double start = stamps[0];
    std::transform(stamps.begin(), stamps.end(), stamps.begin(), [&](double t) { return t - start; });
    auto grid = fit_time_grid(stamps, spec.rate_hz);
    if (grid && !unit_known && std::fabs(grid->dt_s * *spec.rate_hz - 1.0) > kRateTolerance) {
      return rates_disagree(*spec.rate_hz, 1.0 / grid->dt_s, unit_known);
    }
    return grid;
  }
  if (!spec.rate_hz) {
    return neither_time_nor_rate(columns.guessed_time(), columns.time_of_text());
  }
  TimeGrid grid;
  grid.dt_s = 1.0 / *spec.rate_hz;
  grid.length = rows;
  return grid;
}

Status set_window(StudyRecording& recording, const Trim& trim) {
  const KeptRows kept = kept_rows(trim, recording.dt_s, recording.length);
  if (kept.count() < kFewestOnGrid) {
    return fail(ErrorCode::TooFewSamples, "The trims leave fewer than 16 samples of the recording.");
  }
  recording.begin = kept.first;
  recording.end = kept.end;
  return {};
}

/// The axis about which a reference tells the channel's rate.
std::optional<std::size_t> told_axis(const ChannelGroup::Member& member) {
  const Channel& channel = *member.channel;
  const bool told = channel.role.quantity == Quantity::AngularRate && !channel.reference.empty();
  return told ? axis_index(channel.role.axis) : std::nullopt;
}

}  // namespace

std::vector<std::string> texts_of(const std::vector<ChannelName>& names) {
  std::vector<std::string> texts;
  for (const ChannelName& name : names) {
    texts.push_back(name.text());
  }
  return texts;
}

std::optional<std::size_t> axis_index(std::string_view axis) { return driftlab::axis_index(axis); }

Result<StudyRecording> make_study_recording(const RecordingSpec& spec, const ColumnNames& names, std::size_t rows,
                                            const RecordingColumns::Samples& column) {
  auto read = RecordingColumns::read(spec, names, column);
  if (!read) {
    return fail(read.error());
  }
  auto grid = grid_of(spec, rows, *read);
  if (!grid) {
    return fail(grid.error());
  }
  auto sound = sound_columns(spec, names, std::move(*read));
  if (!sound) {
    return fail(sound.error());
  }
  if (rows - sound->left_out.size() < kFewestOnGrid) {
    return fail(ErrorCode::TooFewSamples, "Fewer than 16 rows of the recording hold a sample of every sensor.");
  }
  grid->leave_out(sound->left_out, rows);
  const RecordingColumns& columns = sound->columns;
  StudyRecording recording;
  recording.memory = sound->memory;
  recording.id = spec.id;
  recording.condition = spec.condition;
  recording.dt_s = grid->dt_s;
  recording.length = grid->length;
  recording.stamps = grid->stamps;
  if (spec.rate_hz && std::fabs(grid->dt_s * *spec.rate_hz - 1.0) > kRateTolerance) {
    recording.notes.push_back("The stated rate of " + short_text(*spec.rate_hz) +
                              " Hz and the time column contradict each other: it was measured as " +
                              short_text(1.0 / grid->dt_s) + " Hz, which is used.");
  }
  if (auto status = set_window(recording, spec.trim); !status) {
    return fail(status.error());
  }
  if (!spec.calibration.empty()) {
    recording.notes.push_back("Its calibration '" + spec.calibration +
                              "' is not applied: what is examined are the readings as the sensor gave them.");
  }
  if (std::string note = columns.note_of_time(); !note.empty()) {
    recording.notes.push_back(std::move(note));
  }
  set_rotation(recording, columns, *grid);
  // A temperature that is finite anywhere is finite throughout (sound_columns.hpp).
  if (const auto index = columns.find(Quantity::Temperature); index && std::isfinite(columns.samples(*index).front())) {
    recording.temperature = column_on_grid(columns, *index, *grid);
  }
  const Presence present = presence_of(*grid);
  recording.notes.insert(recording.notes.end(), sound->notes.begin(), sound->notes.end());
  for (const std::size_t i : sound->examined) {
    const ColumnRole role = columns.role(i).value_or(ColumnRole{});
    Channel channel;
    channel.column = names[i];
    channel.role = role;
    channel.unit = role.unit.value_or(Unit{});
    channel.rows = columns.samples(i);
    channel.measured = column_on_grid(columns, i, *grid);
    channel.valid = present;
    const auto axis = axis_index(role.axis);
    if (role.quantity == Quantity::SpecificForce && axis) {
      recording.force[*axis] = channel.measured;
    }
    set_error(recording, channel, columns, *grid);
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

double noise_of_reference(const ChannelGroup::Member& member) {
  const auto axis = told_axis(member);
  return axis ? member.recording->reference_noise.at(*axis).density_ratio : 0.0;
}

bool beside_coarse_reference(const ChannelGroup::Member& member) {
  const auto axis = told_axis(member);
  return axis && member.recording->reference_noise.at(*axis).coarse;
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
