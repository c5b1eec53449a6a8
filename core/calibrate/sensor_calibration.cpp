#include "core/calibrate/sensor_calibration.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <string>
#include <utility>

namespace driftlab {
namespace {

using Axes = std::array<ChannelView*, 3>;

Axes channels_of(Quantity quantity, RecordingView& view) {
  Axes axes{};
  for (ChannelView& channel : view.channels) {
    const std::size_t axis = std::string_view("xyz").find(channel.role.axis);
    if (channel.role.quantity == quantity && channel.role.axis.size() == 1 && axis < 3) {
      axes[axis] = &channel;
    }
  }
  return axes;
}

/// Readings [the calibration's unit] of a channel over the rows `shared`, its reference put back.
std::vector<double> readings(const ChannelView& channel, const Unit& reading, const Stretch& shared) {
  const Unit unit = channel.role.unit.value_or(Unit{});
  std::vector<double> result;
  result.reserve(shared.rows());
  for (const RowRun& run : shared.runs) {
    const std::span<const double> values = channel.rows(run.first, run.count);
    const double* const reference =
        channel.reference.empty() ? nullptr : &channel.reference[values.data() - channel.values.data()];
    for (std::size_t i = 0; i < run.count; ++i) {
      const double measured = values[i] + (reference != nullptr ? reference[i] : 0.0);
      result.push_back(reading.from_si(unit.to_si(measured)));
    }
  }
  return result;
}

/// The part of a channel's reference over the rows `shared`, in `unit` instead of the channel's.
std::vector<double> shared_reference(const ChannelView& channel, const Unit& unit, const Stretch& shared) {
  std::vector<double> result;
  if (channel.reference.empty()) {
    return result;
  }
  const Unit own = channel.role.unit.value_or(Unit{});
  for (const RowRun& run : shared.runs) {
    const auto first = channel.rows(run.first, run.count).data() - channel.values.data();
    for (std::size_t i = 0; i < run.count; ++i) {
      result.push_back(unit.from_si(own.to_si(channel.reference[static_cast<std::size_t>(first) + i])));
    }
  }
  return result;
}

/// Runs that every one of `channels` has, as one stretch.
Stretch shared_stretch(const std::vector<const ChannelView*>& channels) {
  std::vector<RowRun> shared = channels.front()->stretch.runs;
  for (const ChannelView* const channel : channels) {
    shared = shared_runs(shared, channel->stretch.runs);
  }
  return choose_stretch(shared);
}

/// A channel as it will be.
struct Corrected {
  ChannelView* channel = nullptr;
  Unit unit;
  Stretch stretch;
  std::vector<double> values;
  std::vector<double> reference;
};

Result<Corrected> correct_axis(const SensorCalibration& calibration, const Axes& axes, std::size_t axis,
                               const Unit& si) {
  std::vector<const ChannelView*> needed;
  std::vector<std::size_t> columns;
  for (std::size_t j = 0; j < 3; ++j) {
    if (j != axis && calibration.correction[axis][j] == 0.0) {
      continue;
    }
    if (axes[j] == nullptr) {
      return fail(ErrorCode::InvalidArgument,
                  "The calibration corrects column '" + axes[axis]->column + "' by the " + std::string(1, "xyz"[j]) +
                      " axis too, which the recording does not have.",
                  {{"parameter", "calibration"}, {"column", axes[axis]->column}});
    }
    const Unit unit = axes[j]->role.unit.value_or(Unit{});
    if (unit.dimension != calibration.reading.dimension) {
      return fail(ErrorCode::UnitMismatch,
                  "The calibration is of readings in " + calibration.reading.symbol + "; column '" + axes[j]->column +
                      "' is in " + unit.symbol + ".",
                  {{"parameter", "calibration"}, {"column", axes[j]->column}, {"unit", unit.symbol}});
    }
    needed.push_back(axes[j]);
    columns.push_back(j);
  }
  Corrected result{axes[axis], axes[axis]->role.unit.value_or(Unit{}), shared_stretch(needed), {}, {}};
  if (result.stretch.longest().count < 2) {
    return fail(ErrorCode::TooFewSamples, "The axes that the calibration combines share no sound samples.",
                {{"parameter", "calibration"}});
  }
  if (result.unit.dimension != si.dimension) {
    result.unit = si;
  }
  result.reference = shared_reference(*axes[axis], result.unit, result.stretch);
  result.values.assign(result.stretch.rows(), 0.0);
  for (std::size_t k = 0; k < needed.size(); ++k) {
    const double factor = calibration.correction[axis][columns[k]];
    const std::vector<double> y = readings(*needed[k], calibration.reading, result.stretch);
    for (std::size_t i = 0; i < y.size(); ++i) {
      result.values[i] += factor * (y[i] - calibration.bias[columns[k]]);
    }
  }
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    const double reference = result.reference.empty() ? 0.0 : result.reference[i];
    result.values[i] = result.unit.from_si(result.values[i]) - reference;
  }
  return result;
}

Status correct_sensor(const SensorCalibration& calibration, Quantity quantity, const Unit& si, RecordingView& view) {
  const Axes axes = channels_of(quantity, view);
  std::vector<Corrected> corrected;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axes[axis] == nullptr) {
      continue;
    }
    auto result = correct_axis(calibration, axes, axis, si);
    if (!result) {
      return fail(std::move(result.error()));
    }
    corrected.push_back(std::move(*result));
  }
  std::string names;
  for (Corrected& one : corrected) {
    ChannelView& channel = *one.channel;
    names += (names.empty() ? "'" : ", '") + channel.column + "'";
    channel.role.unit = one.unit;
    channel.stretch = std::move(one.stretch);
    channel.gaps = channel.stretch.gaps();
    channel.owned = std::move(one.values);
    channel.reference = std::move(one.reference);
    channel.values = channel.owned;
  }
  if (!names.empty()) {
    view.window.quality.notes.push_back("The readings of " + names + " are corrected by a calibration.");
  }
  return {};
}

}  // namespace

Triple SensorCalibration::correct(const Triple& reading_value) const {
  Triple x{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      x[i] += correction[i][j] * (reading_value[j] - bias[j]);
    }
  }
  return x;
}

SensorCalibration to_apply(const TriadCalibration& calibration, const Unit& si) {
  Eigen::Matrix3d law;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      law(i, j) = calibration.law.matrix[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  const Eigen::Matrix3d inverse = law.inverse();
  SensorCalibration result{si, calibration.law.bias, {}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result.correction[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = inverse(i, j);
    }
  }
  return result;
}

SensorCalibration to_apply(const MultiPositionCalibration& calibration, const Unit& reading) {
  SensorCalibration result{reading, {}, {}};
  for (std::size_t i = 0; i < 3; ++i) {
    result.bias[i] = calibration.bias[i].value;
    for (std::size_t j = 0; j < 3; ++j) {
      result.correction[i][j] = calibration.correction[i][j].value;
    }
  }
  return result;
}

Status apply_calibration(const Calibration& calibration, RecordingView& view) {
  if (calibration.accelerometer) {
    const Unit si = *parse_unit("m/s^2");
    if (auto done = correct_sensor(*calibration.accelerometer, Quantity::SpecificForce, si, view); !done) {
      return done;
    }
  }
  if (calibration.gyroscope) {
    const Unit si = *parse_unit("rad/s");
    if (auto done = correct_sensor(*calibration.gyroscope, Quantity::AngularRate, si, view); !done) {
      return done;
    }
  }
  return {};
}

}  // namespace driftlab
