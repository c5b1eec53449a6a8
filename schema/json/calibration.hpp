#pragma once
/// The calibration of a triad as JSON.
#include "core/calibrate/multi_position.hpp"
#include "core/calibrate/six_position.hpp"
#include "schema/json/json.hpp"

#include <string>

namespace driftlab {

/// Bias, scale-factor errors, misalignments with intervals, the law as a matrix, residuals. `unit` is SI: m/s^2 or
/// rad/s.
[[nodiscard]] Json to_json(const TriadCalibration& calibration, std::string_view unit);

[[nodiscard]] Json to_json(const MultiPositionCalibration& calibration);

/// A few lines for people: each axis with bias and scale factor, +- half the interval.
[[nodiscard]] std::string to_text(const TriadCalibration& calibration, std::string_view unit);
[[nodiscard]] std::string to_text(const MultiPositionCalibration& calibration);

}  // namespace driftlab
