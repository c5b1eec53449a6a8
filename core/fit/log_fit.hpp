#pragma once
/// Squared distance of a model from the logarithms of the wavelet variances.
///
/// L(theta) = r' (S + delta^2 I)^-1 r with r = y - ln nu(theta); y and S belong to the curve alone
/// (core/fit/curve_covariance.hpp) and delta to all its candidates (core/fit/discrepancy.hpp). At delta = 0 the minimum
/// of L is chi-square(scales - parameters) if the model is right. The profile of L gives intervals that hold even at
/// scales of a few degrees of freedom, where nu^ itself is far from Gaussian.
#include "core/fit/discrepancy.hpp"
#include "core/fit/gmwm.hpp"
#include "core/signal/estimate.hpp"

#include <Eigen/Core>

#include <memory>
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
  /// `model` is where the search starts, with positive levels only; `curve` is that of the moments.
  LogFit(const WaveletMoments& moments, Model model, std::shared_ptr<const WhitenedCurve> curve);

  [[nodiscard]] const std::vector<LogCoordinate>& coordinates() const { return coordinates_; }
  [[nodiscard]] Eigen::Index scales() const { return curve_->curve.rows(); }
  [[nodiscard]] const WhitenedCurve& curve() const { return *curve_; }
  /// The coordinates at which L is least, and its value there.
  [[nodiscard]] const Eigen::VectorXd& best() const { return best_; }
  [[nodiscard]] double minimum() const { return minimum_; }
  /// Minimises again from `start` and keeps the result if L is smaller there.
  bool improve(Eigen::VectorXd start);
  [[nodiscard]] Model model_at(const Eigen::VectorXd& coordinates) const;

  /// The model at best().
  [[nodiscard]] Model model() const { return model_at(best_); }
  /// Whether best() is where L is least to a relative 10^-6 of its fall by one more step.
  [[nodiscard]] bool converged() const;
  /// r at best(), not whitened.
  [[nodiscard]] Eigen::VectorXd residual() const;

  /// Standard errors of the coordinates if y scatters with `scatter` about the model (sandwich_covariance): the fast
  /// preview. Some 10^7 where the data do not determine one.
  [[nodiscard]] Eigen::VectorXd sandwich(const BlockDiagonal& scatter) const;
  /// The same with the scatter that L is whitened by.
  [[nodiscard]] Eigen::VectorXd sandwich() const { return sandwich(curve_->scatter); }

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
  std::shared_ptr<const WhitenedCurve> curve_;
  std::vector<LogCoordinate> coordinates_;
  Eigen::VectorXd best_;
  double minimum_ = 0.0;
  int restarts_ = 0;
};

}  // namespace driftlab
