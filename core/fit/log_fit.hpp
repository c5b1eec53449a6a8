#pragma once
/// Quasi-likelihood of a model on the logarithms of the wavelet variances.
///
/// When nu^_j is scaled chi-square with eta_j degrees of freedom, y_j = ln nu^_j - [psi(eta_j/2) - ln(eta_j/2)] is
/// unbiased for ln nu_j. R is the covariance of the logarithms at the fit: psi'(eta_j/2) on the diagonal, and off the
/// diagonal the covariance of the logarithms of correlated chi-square variables whose covariance is that of the nu^
/// (Kibble 1941: a series in their correlation, whose first term is the relative covariance). With the first term alone
/// the J test rejects 2.2 % of true models at a nominal 5 % (N = 9,000).
///
/// L(theta) = r' R^-1 r with r = y - ln nu(theta). At its minimum it is chi-square(scales - parameters) if the model is
/// right. Its profile gives intervals that hold even at scales of a few degrees of freedom, where nu^ itself is far
/// from Gaussian.
#include "core/fit/gmwm.hpp"
#include "core/signal/estimate.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace driftlab {

/// Coordinates of a model: first ln of every squared level, then ln of every shape, in the order of the model's
/// processes.
struct LogCoordinate {
  std::size_t process = 0;
  std::size_t parameter = 0;  ///< 0: the level (the coordinate is 2 ln level), 1 and more: a shape
  double low = 0.0;           ///< where the search stops: the component is gone, or the record cannot tell
  double high = 0.0;
};

class LogFit {
 public:
  /// `model` is the fit, with positive levels only; `covariance` is that of the wavelet variances under it. Scales
  /// whose variance is 0 take no part.
  LogFit(const WaveletMoments& moments, Model model, const Eigen::MatrixXd& covariance);

  [[nodiscard]] const std::vector<LogCoordinate>& coordinates() const { return coordinates_; }
  [[nodiscard]] Eigen::Index scales() const { return y_.size(); }
  /// Degrees of freedom of the longest scale's variance under the fit.
  [[nodiscard]] double longest_edf() const { return longest_edf_; }
  /// The coordinates at which L is least, and its value there.
  [[nodiscard]] const Eigen::VectorXd& best() const { return best_; }
  [[nodiscard]] double minimum() const { return minimum_; }
  /// ln det R.
  [[nodiscard]] double log_det() const { return -2.0 * whitening_.diagonal().array().abs().log().sum(); }
  /// Minimises again from `start` and keeps the result if L is smaller there.
  bool improve(Eigen::VectorXd start);
  [[nodiscard]] Model model_at(const Eigen::VectorXd& coordinates) const;

  /// Standard errors of the coordinates from the curvature, (D' R^-1 D)^-1: the fast preview. Infinite where singular.
  [[nodiscard]] Eigen::VectorXd sandwich() const;

  /// All values of coordinate `k` whose profiled L is within `rise` of the minimum. An end that lies beyond the search
  /// range is open (infinite). Lowers best() and minimum() if a constrained fit finds a smaller L.
  [[nodiscard]] Interval profile(std::size_t k, double rise);

  /// How far L exceeds its minimum if coordinate `k` is held at `value` and the others are free; chi-square(1) at the
  /// true value. At least 0. Lowers best() and minimum() if the constrained fit finds a smaller L.
  [[nodiscard]] double rise_at(std::size_t k, double value);

  /// Ratio of the largest to the smallest singular value of the Jacobian of the whitened residual. It measures how
  /// unequally the data determine the combinations of the coordinates, and is infinite if one of them is not determined
  /// at all.
  [[nodiscard]] double condition_number() const;

  /// Coordinates that lie at an end of their range.
  [[nodiscard]] std::vector<std::size_t> at_bound() const;

  /// L and, where asked for, the whitened residual and its Jacobian (scales x coordinates).
  double evaluate(const Eigen::VectorXd& coordinates, Eigen::VectorXd* residual, Eigen::MatrixXd* jacobian) const;

 private:
  double minimise(Eigen::VectorXd& at, std::optional<std::size_t> fixed) const;
  double constrained(std::size_t k, double value, Eigen::VectorXd& warm) const;

  const WaveletMoments& moments_;
  Model model_;
  std::vector<Eigen::Index> used_;
  Eigen::VectorXd y_;
  Eigen::MatrixXd whitening_;
  std::vector<LogCoordinate> coordinates_;
  Eigen::VectorXd best_;
  double minimum_ = 0.0;
  double longest_edf_ = 0.0;
  int restarts_ = 0;
};

}  // namespace driftlab
