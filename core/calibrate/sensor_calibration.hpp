#pragma once
/// A calibration as it is applied to the readings of a triad.
///
///   x = C (y - b)
///
/// y the reading in the calibration's own unit (SI, or counts of a converter), b the bias in the same, C a matrix that
/// undoes scale factors and misalignment and carries the unit, x the true value in SI. A six-position test
/// (core/calibrate/six_position.hpp) gives C as the inverse of its law, positions in any attitude
/// (core/calibrate/multi_position.hpp) give C itself, upper triangular.
///
/// A bias that stays the same changes no variance. What calibration takes out of an error series is what moves with the
/// true value: the scale factor and the other axes' motion.
#include "core/calibrate/multi_position.hpp"
#include "core/calibrate/six_position.hpp"
#include "core/signal/recording_view.hpp"

#include <optional>

namespace driftlab {

struct SensorCalibration {
  Unit reading;                        ///< of y
  Triple bias{};                       ///< b [reading]
  std::array<Triple, 3> correction{};  ///< C [SI in one reading unit]

  [[nodiscard]] Triple correct(const Triple& reading_value) const;
};

struct Calibration {
  std::optional<SensorCalibration> accelerometer;
  std::optional<SensorCalibration> gyroscope;
};

/// Precondition: the matrix of the law is regular, as every estimate is. `si` is m/s^2 or rad/s.
[[nodiscard]] SensorCalibration to_apply(const TriadCalibration& calibration, const Unit& si);
/// `reading`: the unit that the calibrated readings were in.
[[nodiscard]] SensorCalibration to_apply(const MultiPositionCalibration& calibration, const Unit& reading);

/// Corrects the readings of every sensor that the calibration is of; references stay subtracted. A channel keeps its
/// unit if that measures its quantity, else it is in SI from here on. Where a row of an axis needs those of other axes
/// (C has entries off its diagonal), rows that are not sound in all of them are left out, as a gap. A note in `quality`
/// names the channels.
/// Errors: UnitMismatch (readings do not convert into the unit the calibration was made in), InvalidArgument (an axis
/// that a correction needs is not there), TooFewSamples (the axes share no rows). O(rows).
[[nodiscard]] Status apply_calibration(const Calibration& calibration, RecordingView& view);

}  // namespace driftlab
