#pragma once
/// A calibration in the form in which it is applied to the readings of a triad.
///
///   x = C (y - b)
///
/// y is the reading in the calibration's own unit (SI, or counts of a converter), b the bias in the same unit, and x
/// the true value in SI. The matrix C removes scale factor errors and misalignment and converts the unit. A
/// six-position test (core/calibrate/six_position.hpp) gives C as the inverse of its error model; positions in
/// arbitrary attitudes (core/calibrate/multi_position.hpp) give C itself, upper triangular.
///
/// A constant bias changes no variance. Calibration removes from an error series what varies with the true value: the
/// scale factor error and the sensitivity to the motion of the other axes.
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

/// Corrects the readings of every sensor that the calibration covers; references stay subtracted. A channel keeps its
/// unit if that measures its quantity, and otherwise becomes SI. If the correction of an axis needs the other axes (C
/// has entries off its diagonal), rows that are not sound in all of them are left out and form a gap. A note in
/// `quality` names the channels. Errors: UnitMismatch (the readings do not convert into the unit of the calibration),
/// InvalidArgument (an axis that a correction needs is missing), TooFewSamples (the axes share no rows). O(rows).
[[nodiscard]] Status apply_calibration(const Calibration& calibration, RecordingView& view);

}  // namespace driftlab
