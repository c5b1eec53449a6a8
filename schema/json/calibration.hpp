#pragma once
/// The calibration of a triad as JSON.
#include "core/analysis/calibrate.hpp"
#include "core/calibrate/multi_position.hpp"
#include "core/calibrate/sensor_calibration.hpp"
#include "core/calibrate/six_position.hpp"
#include "schema/json/json.hpp"

#include <string>

namespace driftlab {

/// Bias, scale-factor errors, misalignments with intervals, the law as a matrix, residuals, and `apply`, what corrects
/// readings. `si` is m/s^2 or rad/s.
[[nodiscard]] Json to_json(const TriadCalibration& calibration, const Unit& si);

/// `reading`: the unit of the readings that were calibrated.
[[nodiscard]] Json to_json(const MultiPositionCalibration& calibration, const Unit& reading);

/// The whole document: `accelerometer`, `gyroscope`, `notes`.
[[nodiscard]] Json to_json(const CalibrationReport& report);

/// The `apply` of `accelerometer` and `gyroscope` of a calibration document; other members are not read. A document
/// with neither is a fault.
[[nodiscard]] Calibration calibration_from_json(const Json& document, const std::string& pointer, Faults& faults);

}  // namespace driftlab
