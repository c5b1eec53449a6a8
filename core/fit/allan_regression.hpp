#pragma once
/// Coefficients of IEEE Std 952 (Q, N, B, K, R) from the Allan variance.
///
/// Model: AV(tau) = 3 Q^2/tau^2 + N^2/tau + (flicker of B) + K^2 tau/3 + R^2 tau^2/2, in the exact sampled forms of
/// core/process. All scales enter at once, weighted by the inverse of their covariance under the fit, levels
/// non-negative; nothing is read off "where the slope is -1/2". Intervals by profile of the quasi-likelihood on the
/// logarithms; where the five terms do not fit (L above its degrees of freedom) they are widened by that ratio (Birge
/// 1932). A coefficient without a lower limit is not identifiable and comes back empty with the reason.
#include "core/fit/candidate.hpp"
#include "core/fit/characterisation.hpp"

namespace driftlab {

/// `sd`: standard deviations of the wavelet variances; `unit`: SI units in one unit of the moments.
[[nodiscard]] AllanParameters allan_regression(const WaveletMoments& moments, const Eigen::VectorXd& sd,
                                               const CovarianceLaw& covariance_of, double unit);

}  // namespace driftlab
