#pragma once
/// Propagation of the error of one sensor axis over a step of several samples, exact for every process that has a state
/// space.
///
/// The axis has a constant bias (if its standard deviation is not 0) and the states of its processes. In addition a
/// step carries three integrals of the error y over its samples, with each sample held constant, as an integrating
/// sensor outputs it:
///   I1 = int y,  I2 = int int y,  I3 = int int int y.
/// The angle, velocity and position errors of a filter are rotations of these integrals. One sample is the linear step
///   z' = M z + noise,  z = (states, I1, I2, I3),
/// with M and the noise from StateSpace (core/process/state_space.hpp). A step of L samples is M^L with the noise
/// accumulated through it. This is exact for any L; no series in L dt is involved.
#include "core/navigate/imu_model.hpp"

#include <Eigen/Core>

#include <vector>

namespace driftlab {

/// A bias and flicker noise, which takes 16 states, and three more.
inline constexpr int kMaxAxisStates = 20;

using AxisMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxAxisStates, kMaxAxisStates>;
using AxisVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxAxisStates, 1>;
using AxisGains = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor, 3, kMaxAxisStates>;

/// A step of a fixed number of samples.
struct ChannelStep {
  AxisMatrix phi;          ///< states -> states
  AxisGains gain;          ///< states -> I1, I2, I3
  AxisMatrix state_noise;  ///< covariance of the states' noise
  AxisGains cross_noise;   ///< covariance of (I1, I2, I3) with the states' noise
  Matrix3 integral_noise;  ///< covariance of (I1, I2, I3)
};

/// One axis under one model.
struct ChannelDynamics {
  int states = 0;
  bool diagonal = true;  ///< phi has no entry off its diagonal
  AxisVector start;      ///< expected states at the beginning
  AxisMatrix start_covariance;
  AxisVector output;               ///< y = output . states + white noise
  AxisMatrix sample_phi;           ///< over one sample
  std::vector<ChannelStep> steps;  ///< steps[L - 1] for L = 1 .. most
};

/// A process whose state space is approximate (flicker noise) is held as that. Errors: InvalidArgument (a process
/// without a state space), LimitExceeded (more than 20 states).
[[nodiscard]] Result<ChannelDynamics> make_channel_dynamics(const Model& model, double bias_sd, double dt_s, int most);

}  // namespace driftlab
