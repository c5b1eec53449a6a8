#pragma once
/// The coefficients Q, N, B, K and R of IEEE Std 952, estimated from the Allan variance.
///
/// Model: AV(tau) = 3 Q^2/tau^2 + N^2/tau + (flicker of B) + K^2 tau/3 + R^2 tau^2/2, in the exact sampled forms of
/// core/process. All scales are fitted together, weighted by the inverse of their covariance under the fit, with
/// non-negative levels; no coefficient is read off at a slope of the log-log plot. Intervals are profiles of the
/// quasi-likelihood on the logarithms. If the five terms do not fit, that is if L exceeds its degrees of freedom, they
/// are widened by that ratio (Birge 1932). A coefficient without a lower limit is not identifiable; it is left empty
/// and the reason is given.
#include "core/fit/candidate.hpp"
#include "core/fit/characterisation.hpp"

namespace driftlab {

/// `sd` are the standard deviations of the wavelet variances; `unit` is the number of SI units in one unit of the
/// moments.
[[nodiscard]] AllanParameters allan_regression(const WaveletMoments& moments, const Eigen::VectorXd& sd,
                                               const CovarianceLaw& covariance_of, double unit);

}  // namespace driftlab
