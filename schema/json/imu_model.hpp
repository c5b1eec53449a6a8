#pragma once
/// Sensor members of a scenario document: what a unit's axes do wrong.
#include "core/navigate/imu_simulator.hpp"
#include "core/signal/unit.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Reads one sensor (three axes) into channels first .. first + 2. Forms:
///   {"processes": [...], "constant_bias_sd_deg_s": 0.05}                    the same on every axis
///   {"by_rate": {"bounds_deg_s": [...], "processes": [[...], ...], "hysteresis_deg_s": 0.5}}   bands of |rate|
///   {"trend": {"rates_deg_s": [...], "processes": [[...], ...], "step_deg_s": 0.25}}           continuous in |rate|
///   {"x": {...}, "y": {...}, "z": {...}}                                    per axis, each as above
///   accelerometer also {"white_noise_mg_per_sqrt_hz", "constant_bias_sd_mg", "in_run": {"process", "sigma_mg",
///   "tau_s"}}
/// Bias: constant_bias_sd_deg_s, constant_bias_sd_mg.
void read_sensor(const Json& sensor, std::size_t first, const std::string& pointer, ImuModel& model, Faults& faults);

/// `processes` or `by_rate`, as above.
[[nodiscard]] Json schedule_to_json(const ModelSchedule& schedule, Dimension dimension);

[[nodiscard]] Json sensor_to_json(const ImuModel& model, std::size_t first);

/// Deterministic errors of one sensor, numbers or lists of three: `bias`, `scale_factor`, `quantization_step`, `range`
/// and `bandwidth_hz`, in deg/s or m/s^2; `misalignment_mrad` is a 3 by 3 list of rows.
void read_hardware(const Json& hardware, std::size_t first, const std::string& pointer, ImuHardware& out,
                   Faults& faults);

/// Empty object where there is nothing.
[[nodiscard]] Json hardware_to_json(const ImuHardware& hardware, std::size_t first);

}  // namespace driftlab
