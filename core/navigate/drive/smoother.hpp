#pragma once
/// The smoothed trajectory of a drive, from the fixes before and after each moment. It serves as the reference for a
/// filter's errors if a drive has none of its own.
///
/// The filter runs once and keeps, in order, its transitions Phi and its scalar measurements (h, gain K, innovation z
/// of variance s). Backward over these runs the smoother of Bierman (1973, "Fixed interval smoothing with discrete
/// measurements"), which is that of Rauch, Tung and Striebel without an inverse of a covariance: from lambda = 0,
/// Lambda = 0 at the end,
///   over a measurement  lambda <- -h z/s + (I - K h^T)^T lambda,  Lambda <- h h^T/s + (I - K h^T)^T Lambda (I - K
///   h^T), over a step         lambda <- Phi^T lambda,  Lambda <- Phi^T Lambda Phi,
/// and at a point whose filtered covariance is P the error is -P lambda with covariance P - P Lambda P. The filter
/// feeds its errors back, which is the same to first order in them.
///
/// About 10 kB of memory a tenth of a second; time grows with the cube of the states, 2 s for ten minutes.
#include "core/navigate/drive/evaluation.hpp"

namespace driftlab::drive {

/// The record of a filter run that the backward pass needs. One for each run of readings.
class FilterTape {
 public:
  /// A transition of all states.
  void step(const Eigen::MatrixXd& transition);
  /// The scalar measurements of one moment, in order, of a filter whose covariance before them is given.
  void measured(const Eigen::MatrixXd& covariance, std::span<const WideMeasurement> measurements);
  /// A moment that is wanted.
  void point(double time_s, const NavigationState& state, const Eigen::MatrixXd& covariance);
  [[nodiscard]] double last_point_s() const;

  struct Point {
    double time_s = 0.0;  ///< on the drive's clock
    NavigationState state;
    Eigen::Matrix<double, 9, 9> covariance;  ///< position, velocity, attitude errors in e
  };
  /// By time.
  [[nodiscard]] std::vector<Point> smoothed() const;

 private:
  struct Scalar {
    Eigen::VectorXd h, gain;
    double innovation, variance;
  };
  struct Kept {
    enum class What { Step, Scalar, Point } what;
    std::size_t index;
  };
  struct Filtered {
    double time_s;
    NavigationState state;
    Eigen::MatrixXd rows;  ///< the first nine of the covariance
  };
  std::vector<Kept> order_;
  std::vector<Eigen::MatrixXd> steps_;
  std::vector<Scalar> scalars_;
  std::vector<Filtered> points_;
};

/// Every tenth of a second or so, over all runs of readings; times on the drive's clock. Moments whose covariance is
/// not positive are left out: the first seconds, in which it is a small difference of large numbers.
[[nodiscard]] std::vector<FilterTape::Point> smoothed_path(const PreparedDrive& prepared);

/// The drive with its antenna's smoothed path as reference. A note states what that reference shares with the filter.
/// Errors: those of PreparedDrive::make; TooFewSamples.
[[nodiscard]] Result<Drive> with_smoothed_reference(Drive drive, const FilterOptions& options);

}  // namespace driftlab::drive
