#pragma once
/// From recordings to a calibration document: the one path that CLI and daemon share.
#include "core/calibrate/known_positions.hpp"
#include "core/signal/condition.hpp"
#include "core/signal/recording_view.hpp"
#include "schema/json/json.hpp"

#include <string>

namespace driftlab {

struct CalibrateOptions {
  double gravity_m_s2 = kStandardGravity;
  bool misalignment = false;  ///< of a six-position test: estimate how the axes lie to each other too
};

/// A calibration in lines for people and as a document: `accelerometer`, `gyroscope`, `notes`.
struct CalibrationReport {
  std::string text;
  Json document = Json::object();
};

/// Recordings are handed in one by one and not kept. Several, or one under `six_position`: known positions
/// (core/calibrate/six_position.hpp). One under any other condition: rests in any attitude
/// (core/calibrate/multi_position.hpp).
class RecordingCalibrator {
 public:
  /// `recordings`: how many will be handed in.
  RecordingCalibrator(std::size_t recordings, const CalibrateOptions& options);

  /// Errors: those of add_positions, find_still_intervals, calibrate_multi_position; UnknownColumn (no accelerometer).
  [[nodiscard]] Status add(const RecordingSpec& spec, const RecordingView& view);

  /// Errors: those of calibrate_six_positions, naming the sensor; TooFewSamples (no position and no known rate).
  [[nodiscard]] Result<CalibrationReport> finish();

 private:
  Status add_rests(const RecordingView& view);

  std::size_t recordings_;
  CalibrateOptions options_;
  KnownPositions positions_;
  CalibrationReport report_;
};

}  // namespace driftlab
