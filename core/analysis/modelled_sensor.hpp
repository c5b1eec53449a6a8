#pragma once
/// A part of the use case "evaluate outages": the errors that a simulation model, which an investigation left, gives
/// one sensor of a scenario.
///
/// A model speaks of columns of a recording; a scenario of the axes of a gyroscope or an accelerometer. An axis takes
/// the column that is named for the sensor; without a name gx, gy, gz of a gyroscope and fx, fy, fz of an
/// accelerometer; else the only one there is; and where the model does not tell columns apart, what it says of all. A
/// drift [SI/s] becomes the process `linear_drift`. A scenario has no place for effects of the motion or of the
/// temperature, and a filter cannot know a bias: what is left out is named.
#include "core/investigate/study/study.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace driftlab {

struct ScenarioSensor {
  bool gyro = true;   ///< else an accelerometer
  bool truth = true;  ///< the sensor itself, else what a filter believes of it
  std::vector<std::size_t> axes = {0, 1, 2};
  std::string column = {};  ///< the one that is meant for all of them; empty: by the rule above
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
