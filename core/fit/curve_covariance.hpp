#pragma once
/// The logarithms of one curve of wavelet variances and the covariance S of their errors: one S for every model that is
/// held against the curve.
///
/// When nu^_j is scaled chi-square with eta_j degrees of freedom, y_j = ln nu^_j - [psi(eta_j/2) - ln(eta_j/2)] is
/// unbiased for ln nu_j. S has psi'(eta_j/2) on its diagonal; off the diagonal it has the covariance of the logarithms
/// of correlated chi-square variables whose covariance is that of the nu^ (Kibble 1941: a series in their correlation,
/// whose first term is the relative covariance). With the first term alone the J test rejects 2.2 % of true models at a
/// nominal 5 % (N = 9,000).
///
/// The covariance of the nu^ needs a model of the noise, but not that of a candidate: a non-negative mixture of
/// dictionary processes that describes the curve (core/variance/variance_intervals.hpp) serves for all of them. If each
/// candidate brought its own, a model that puts too much noise into the long scales would be excused for missing them,
/// and the distances of nested models would not be ordered.
#include "core/process/block_diagonal.hpp"

#include <Eigen/Core>

#include <vector>

namespace driftlab {

struct CurveCovariance {
  std::vector<Eigen::Index> used;  ///< rows of the curve that take part: those with a positive variance
  Eigen::VectorXd log_variance;    ///< y, one entry per row used
  BlockDiagonal covariance;        ///< S, rows used x rows used: a block for each recording
  Eigen::VectorXd edf;             ///< eta, one entry per row used

  /// psi(eta_j/2) - ln(eta_j/2): what the logarithm of entry j falls short of ln nu_j on average.
  [[nodiscard]] double bias(Eigen::Index j) const;

  [[nodiscard]] Eigen::Index rows() const { return log_variance.size(); }
};

/// `nu` are the estimated variances; `covariance` is that of the estimates under a mixture whose variances are
/// `described` [unit^2, unit^4], all of one length and in one unit. Rows with nu = 0 take no part. O(rows^2) in each
/// block.
[[nodiscard]] CurveCovariance curve_covariance(const Eigen::VectorXd& nu, const Eigen::VectorXd& described,
                                               const BlockDiagonal& covariance);

}  // namespace driftlab
