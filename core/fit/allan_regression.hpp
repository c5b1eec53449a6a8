#pragma once
/// The coefficients Q, N, B, K and R of IEEE Std 952, estimated from the Allan variance.
///
/// Model: AV(tau) = 3 Q^2/tau^2 + N^2/tau + (flicker of B) + K^2 tau/3 + R^2 tau^2/2, in the exact sampled forms of
/// core/process. All scales are fitted together on their logarithms, under the covariance of the curve, with
/// non-negative levels; no coefficient is read off at a slope of the log-log plot. Intervals are profiles of the
/// squared distance. If the five terms do not fit, that is if their J test rejects them, the fit and its intervals
/// allow for a discrepancy (core/fit/discrepancy.hpp). A coefficient without a lower limit is not identifiable; it is
/// left empty and the reason is given.
#include "core/fit/candidate_set.hpp"
#include "core/fit/characterisation.hpp"

namespace driftlab {

/// `sd` are the standard deviations of the wavelet variances; `unit` is the number of SI units in one unit of the
/// moments.
[[nodiscard]] AllanParameters allan_regression(const WaveletMoments& moments, const Eigen::VectorXd& sd,
                                               CurveCovariance curve, double unit);

}  // namespace driftlab
