#pragma once
/// The use case "calibrate": recordings in, bias, scale factors and misalignments of the triads out.
///
/// Several recordings, or one under `six_position`: known positions (core/calibrate/six_position.hpp). One under any
/// other condition: rests in any attitude (core/calibrate/multi_position.hpp).
#include "core/analysis/recording_source.hpp"
#include "core/calibrate/multi_position.hpp"
#include "core/calibrate/six_position.hpp"
#include "core/signal/condition.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

struct CalibrateOptions {
  double gravity_m_s2 = kStandardGravity;
  bool misalignment = false;  ///< of a six-position test: estimate how the axes lie to each other too
};

/// From rests in any attitude.
struct RestCalibration {
  MultiPositionCalibration found;
  Unit reading;  ///< of the readings that were calibrated
};

/// From known positions.
struct PositionCalibration {
  TriadCalibration found;
  std::size_t positions = 0;
};

/// Either `rests`, or one or both of the others.
struct CalibrationReport {
  std::optional<RestCalibration> rests;  ///< of the accelerometer
  std::optional<PositionCalibration> accelerometer;
  std::optional<PositionCalibration> gyroscope;
  std::vector<std::string> notes;  ///< recordings that give no position, and why
};

/// Recordings are opened one by one and not kept. Errors, located: those of the source, of view_recording,
/// add_positions, find_still_intervals and calibrate_multi_position; UnknownColumn (no accelerometer). Errors of the
/// whole: those of calibrate_six_positions, naming the sensor; TooFewSamples (no position and no known rate);
/// Cancelled.
[[nodiscard]] Result<CalibrationReport> calibrate(RecordingSource& recordings, const CalibrateOptions& options = {},
                                                  const RunControl& control = {});

}  // namespace driftlab
