#pragma once
/// A part of the use case "evaluate outages": the errors of one sensor of a scenario, taken from a simulation model
/// that an investigation made.
///
/// The model has errors for the columns of a recording, the scenario wants them for the axes of a gyroscope or an
/// accelerometer. Where the caller names a column for the sensor, all of its axes take that one. Otherwise an axis
/// takes the column with its usual name: gx, gy, gz of a gyroscope, fx, fy, fz of an accelerometer. If there is none,
/// it takes the only column of the model, or, from a model that names no columns, the errors that hold for all.
///
/// A drift [SI/s] becomes the process `linear_drift`. Not everything can be carried over: a scenario has no place for
/// effects of the motion or the temperature, and a filter is not told the bias. `left_out` names what was dropped.
#include "core/investigate/study/study.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace driftlab {

struct ScenarioSensor {
  bool gyro = true;   ///< else an accelerometer
  bool truth = true;  ///< the sensor itself, else what a filter believes of it
  std::vector<std::size_t> axes = {0, 1, 2};
  std::string column = {};  ///< of the model, for all axes of the sensor; empty: by the rule above
};

struct ModelledAxis {
  std::size_t axis = 0;
  Model processes;
  double bias = 0.0;  ///< known [rad/s] or [m/s^2]
};

struct ModelledSensor {
  std::vector<ModelledAxis> axes;     ///< in the order asked for
  std::vector<std::string> left_out;  ///< causes of effects, and "bias" where a filter is not told one
};

/// Errors: NotFound (no such column), InvalidArgument (columns differ and none is named), both with "parameter";
/// UnitMismatch (the model is one of the other sensor).
[[nodiscard]] Result<ModelledSensor> sensor_of_model(const investigate::Baseline& model, const ScenarioSensor& sensor);

}  // namespace driftlab
