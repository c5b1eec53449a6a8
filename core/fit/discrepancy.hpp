#pragma once
/// Discrepancy: by how much a curve of wavelet variances differs from every model that is offered for it.
///
/// At a million samples the first wavelet variances are known to 0.2 %, and no model of a few processes is right to 0.2
/// %. Weighted by S alone (core/fit/curve_covariance.hpp) a fit then follows the first scales and may miss the long
/// ones by orders of magnitude. So the model is allowed to be wrong: ln nu_j = ln nu_j(theta) + delta e_j with e_j
/// independent of mean 0 and variance 1 (Kennedy and O'Hagan 2001 in its simplest form), and the squared distance is
///   L = r' (S + delta^2 I)^-1 r,  r = y - ln nu(theta).
/// delta is 0 where the data do not reject the model, else the value at which L equals its degrees of freedom. It is
/// the relative error of the variances that is left: "described to 1.2 %". With a delta so chosen L is no test any
/// more. The errors of the scales are taken to be independent; on dense scales neighbours share theirs, and delta is
/// then a lower bound of the relative error.
///
/// If parameters are fitted with the weights of one delta but the misfit corresponds to another, their covariance is
/// the sandwich (Huber 1967; White 1982).
#include "core/fit/curve_covariance.hpp"

#include <Eigen/Core>

#include <functional>

namespace driftlab {

/// A curve with the weights of the distance L.
struct WhitenedCurve {
  CurveCovariance curve;
  double delta = 0.0;       ///< the largest, where the rows of several recordings have each their own
  BlockDiagonal scatter;    ///< S + delta^2 I
  BlockDiagonal whitening;  ///< W with W' W = scatter^-1, lower triangular

  /// L of a model whose wavelet variances [unit^2] at the rows used are `modelled`, which must be positive.
  [[nodiscard]] double distance(const Eigen::VectorXd& modelled) const;
};

[[nodiscard]] WhitenedCurve whitened(CurveCovariance curve, double delta);
/// The same with a delta for each row.
[[nodiscard]] WhitenedCurve whitened(CurveCovariance curve, const Eigen::VectorXd& delta);

/// W with W' W = (covariance + delta^2 I)^-1, lower triangular. Where rounding leaves the matrix indefinite, its
/// diagonal is raised until it is not.
[[nodiscard]] Eigen::MatrixXd discrepancy_whitening(const Eigen::MatrixXd& covariance, double delta);

/// The delta at which r' (covariance + delta^2 I)^-1 r equals `dof` for a given residual: 0 where it is less already.
/// `dof` must be positive. O(rows^3) in each block.
[[nodiscard]] double discrepancy_of(const Eigen::VectorXd& residual, const BlockDiagonal& covariance, double dof);

/// The delta at which `distance`, the least L of a model as a function of delta, equals `dof`, to 1 % of delta: 0 where
/// distance(0) <= dof. Some ten evaluations, at falling and rising values; `first` is a guess.
[[nodiscard]] double find_discrepancy(const std::function<double(double delta)>& distance, double dof, double first);

/// Covariance of coordinates fitted by least |W (y - f)|, where W f has the derivatives D = `slope` (rows x
/// coordinates) and the error of W y has the covariance C = `scatter`: (D'D)^-1 D' C D (D'D)^-1, and (D'D)^-1 where W
/// whitens the error. Coordinates that the data do not determine get a variance of 10^14 and more.
[[nodiscard]] Eigen::MatrixXd sandwich_covariance(const Eigen::MatrixXd& slope, const BlockDiagonal& scatter);

}  // namespace driftlab
