#include "core/analysis/calibrate.hpp"

#include "core/calibrate/known_positions.hpp"
#include "core/calibrate/still_intervals.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {
namespace {

Result<RestCalibration> calibrate_rests(const RecordingView& view, double gravity_m_s2) {
  const auto channels = triad_of(view, Quantity::SpecificForce);
  if (!channels) {
    return fail(ErrorCode::UnknownColumn,
                "The recording needs specific_force along x, y and z; say which columns these are.",
                {{"parameter", "columns"}});
  }
  const auto [first, count] = longest_shared_run(*channels);
  std::array<std::span<const double>, 3> triad;
  for (std::size_t axis = 0; axis < 3 && count > 0; ++axis) {
    triad[axis] = (*channels)[axis]->rows(first, count);
  }
  auto rests = find_still_intervals(triad, 1.0 / view.window.time.dt_s);
  if (!rests) {
    return fail(std::move(rests.error()));
  }
  std::vector<Triple> readings;
  for (const StillInterval& rest : *rests) {
    auto mean = triad_mean({triad[0].subspan(rest.first, rest.count), triad[1].subspan(rest.first, rest.count),
                            triad[2].subspan(rest.first, rest.count)});
    if (mean) {
      readings.push_back(mean->mean);
    }
  }
  auto found = calibrate_multi_position(readings, gravity_m_s2);
  if (!found) {
    return fail(std::move(found.error()));
  }
  return RestCalibration{std::move(*found), channels->front()->role.unit.value_or(Unit{})};
}

/// Nothing where no position moves the sensor.
Result<std::optional<PositionCalibration>> calibrate_positions(const char* sensor,
                                                               const std::vector<KnownPosition>& positions,
                                                               const CalibrateOptions& options) {
  const bool moved = std::any_of(positions.begin(), positions.end(),
                                 [](const KnownPosition& position) { return length(position.truth) > 0.0; });
  if (!moved) {
    return std::optional<PositionCalibration>();
  }
  auto found = calibrate_six_positions(positions, {options.misalignment});
  if (!found) {
    Error error = found.error();
    error.message = std::string("The ") + sensor + ": " + error.message;
    return fail(std::move(error));
  }
  return std::optional(PositionCalibration{*found, positions.size()});
}

/// What one recording adds: rests at once, or its position for the end.
Status add_recording(std::size_t index, RecordingSource& recordings, const CalibrateOptions& options,
                     const RunControl& control, KnownPositions& positions, CalibrationReport& report) {
  auto opened = recordings.open(index, control);
  if (!opened) {
    return fail(opened.error());
  }
  auto view = view_of(*opened);
  if (!view) {
    return fail(view.error());
  }
  if (recordings.count() > 1 || opened->spec.condition.kind == ConditionKind::SixPosition) {
    return add_positions(opened->spec, *view, options.gravity_m_s2, positions);
  }
  auto rests = calibrate_rests(*view, options.gravity_m_s2);
  if (!rests) {
    return fail(rests.error());
  }
  report.rests = std::move(*rests);
  return {};
}

}  // namespace

Result<CalibrationReport> calibrate(RecordingSource& recordings, const CalibrateOptions& options,
                                    const RunControl& control) {
  CalibrationReport report;
  KnownPositions positions;
  const auto count = static_cast<double>(recordings.count());
  for (std::size_t i = 0; i < recordings.count(); ++i) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "The calibration was stopped.");
    }
    const auto done = static_cast<double>(i);
    const RunControl part = part_of(control, done / count, (done + 1.0) / count);
    if (const Status added = add_recording(i, recordings, options, part, positions, report); !added) {
      return fail(recordings.located(i, added.error()));
    }
  }
  auto accelerometer = calibrate_positions("accelerometer", positions.accelerometer, options);
  if (!accelerometer) {
    return fail(accelerometer.error());
  }
  auto gyroscope = calibrate_positions("gyroscope", positions.gyroscope, options);
  if (!gyroscope) {
    return fail(gyroscope.error());
  }
  report.accelerometer = *accelerometer;
  report.gyroscope = *gyroscope;
  report.notes = std::move(positions.notes);
  if (!report.rests && !report.accelerometer && !report.gyroscope) {
    return fail(ErrorCode::TooFewSamples,
                "None of the recordings is a position of a six-position test or a known rate.");
  }
  return report;
}

}  // namespace driftlab
