#pragma once
/// The squared distance of a composite model from the logarithms of a curve of wavelet variances, and its minimum.
///
/// L(theta) = r' (S + delta^2 I)^-1 r, r = y - ln nu(theta), with the S, y and delta of the curve
/// (core/fit/curve_covariance.hpp, core/fit/discrepancy.hpp), which are the same for every model, so that distances of
/// nested models are ordered. The coordinates are the logarithms of all squared levels and shapes; Levenberg and
/// Marquardt's iterations with derivatives from the basis, shapes held inside their ranges.
#include "core/fit/composite_basis.hpp"
#include "core/fit/curve_covariance.hpp"
#include "core/signal/estimate.hpp"

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// A quantity to which some components of a model contribute: the logarithm of the sum of their contributions. It is
/// reported with an interval, which is found by holding it fixed while everything else is free.
struct CompositeQuantity {
  enum class Of {
    Density,  ///< at frequency 0 [unit^2 s]: N^2
    Square,   ///< of the level: K^2 of a random walk, B^2, Q^2, R^2
    Walk,     ///< 2 sigma^2 beta of a Gauss-Markov process: K^2 of the random walk that a short record shows of it
  };
  std::vector<std::size_t> components;
  std::vector<Of> of;  ///< one per component
};
struct CompositeConstraint {
  CompositeQuantity quantity;
  double value = 0.0;
};

class CompositeDistance {
 public:
  /// `curve` must be that of the basis' scales.
  CompositeDistance(const CompositeBasis& basis, const CurveCovariance& curve, double delta = 0.0);

  [[nodiscard]] const CompositeBasis& basis() const { return *basis_; }
  [[nodiscard]] Eigen::Index rows() const { return y_.size(); }
  /// W of W'W = (S + delta^2 I)^-1, and the rows of the basis that take part.
  [[nodiscard]] const Eigen::MatrixXd& whitening() const { return whitening_; }
  [[nodiscard]] const std::vector<Eigen::Index>& used() const { return used_; }
  [[nodiscard]] const Eigen::VectorXd& log_variance() const { return y_; }
  [[nodiscard]] double delta() const { return delta_; }

  [[nodiscard]] double at(const Composite& model) const;
  /// Moves `model` to a minimum near it and returns L there. With a constraint L is that of the point at which it holds
  /// (to 1e-5 of the logarithm). The shapes of the first `settled` components stay as they are.
  double minimise(Composite& model, const std::optional<CompositeConstraint>& constraint = std::nullopt,
                  std::size_t settled = 0) const;
  [[nodiscard]] double value(const Composite& model, const CompositeQuantity& quantity) const;
  /// Its standard error from the curvature at a minimum.
  [[nodiscard]] double standard_error(const Composite& model, const CompositeQuantity& quantity) const;
  /// Standard errors of every coordinate, component by component, its level before its shapes. That of a coordinate
  /// which the curve does not determine is large.
  [[nodiscard]] Eigen::VectorXd standard_errors(const Composite& model) const;
  /// All values of the quantity at which L, everything else free, is within `rise` of that of `model`, a minimum. An
  /// end further than 20 from the estimate, that is e^10 in a level, is open (infinite).
  [[nodiscard]] Interval profile(const Composite& model, const CompositeQuantity& quantity, double rise) const;

 private:
  struct Point;
  struct Columns;
  void evaluate(const Composite& model, const std::optional<CompositeConstraint>& constraint, bool slopes,
                Columns& columns, Point& point) const;

  const CompositeBasis* basis_;
  std::vector<Eigen::Index> used_;
  Eigen::VectorXd y_;
  Eigen::MatrixXd whitening_;
  double delta_;
};

[[nodiscard]] std::size_t parameter_count(const CompositeBasis& basis, const Composite& model);
/// The name of a model: `WN+GM+RW`.
[[nodiscard]] std::string composite_name(const CompositeBasis& basis, const Composite& model);

}  // namespace driftlab
