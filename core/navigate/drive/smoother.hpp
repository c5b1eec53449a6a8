#pragma once
/// The smoothed trajectory of a drive: at each moment the best estimate from all fixes, those before it and those after
/// it. Where a drive has no reference of its own, a filter's errors are measured against it.
///
/// The filter runs once. On its way it keeps each of its transitions Phi and each of its scalar measurements: the row
/// h, the gain K, the innovation z and its variance s. The smoother then goes back over them from the end, where
/// lambda = 0 and Lambda = 0. Over a measurement
///   lambda <- -h z/s + (I - K h^T)^T lambda,
///   Lambda <- h h^T/s + (I - K h^T)^T Lambda (I - K h^T),
/// and over a transition
///   lambda <- Phi^T lambda,
///   Lambda <- Phi^T Lambda Phi.
/// At a point with the filtered covariance P the smoothed error is -P lambda, and its covariance is P - P Lambda P.
/// This is the smoother of Bierman (1973, "Fixed interval smoothing with discrete measurements"); it gives what that of
/// Rauch, Tung and Striebel gives, and inverts no covariance. The filter here corrects its trajectory by the errors as
/// it estimates them, which changes the result only in second order of these errors.
///
/// It takes about 10 kB of memory for each tenth of a second of the drive. The time grows with the cube of the number
/// of states and is 2 s for ten minutes.
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
    double time_s = 0.0;  ///< on the unit's clock
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
