#pragma once
/// The error model of an inertial measurement unit: what a simulator adds and what a filter believes.
#include "core/navigate/model_schedule.hpp"
#include "core/navigate/trajectory.hpp"

#include <array>

namespace driftlab {

/// One sensing axis: stochastic processes by rate band, and a constant bias of unknown value.
struct AxisModel {
  ModelSchedule processes;
  double bias_sd = 0.0;  ///< standard deviation of the constant bias [rad/s or m/s^2]; 0: there is none
};

/// Gyroscope x, y, z, then accelerometer x, y, z, in the order of ImuSample. The schedule of a gyroscope axis is driven
/// by its own rate; accelerometers have one model each (the first of their schedule).
struct ImuModel {
  std::array<AxisModel, kImuChannels> axes;
};

}  // namespace driftlab
