#pragma once
/// A process as a linear state-space model, the form a Kalman filter or smoother needs.
#include <Eigen/Core>

namespace driftlab {

/// x_{t+1} = phi x_t + w_t, cov w = q;  y_t = h x_t + v_t, var v = r;  x_0 ~ (mean0, cov0), one step per sample.
/// Units: y in channel units, so h x has channel units. Second moments are those of the process; a process that is not
/// Gaussian (sinusoid of random phase) has the Gaussian model of the same second moments.
struct StateSpace {
  Eigen::MatrixXd phi;
  Eigen::MatrixXd q;
  Eigen::RowVectorXd h;
  double r = 0.0;
  Eigen::VectorXd mean0;
  Eigen::MatrixXd cov0;
  /// Largest relative error of the spectral density against the process over the band from `lowest_hz` up to the
  /// Nyquist frequency; 0 where the model is exact.
  double relative_error = 0.0;
  double lowest_hz = 0.0;
};

}  // namespace driftlab
