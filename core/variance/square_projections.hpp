#pragma once
/// Low-frequency projections of the squared Haar coefficients: the scatter of a wavelet variance without a noise model.
///
/// The wavelet variance of a scale is the mean of Y_t = W_t^2 over M coefficients, and its variance is S_Y(0)/M, the
/// spectral density of Y at zero. The projections on cosines,
///   L_k = sqrt(2/M) sum_t (Y_t - mean Y) cos(pi k (t + 1/2)/M),   k = 1 .. B,
/// are nearly independent with variance S_Y(k/2M), so that the mean of the first B squares estimates S_Y(0) with B
/// degrees of freedom, and a t quantile of B degrees gives the interval (Mueller 2004; Lazarus, Lewis, Stock and Watson
/// 2018, eq. 10: the equal-weighted cosine estimator). Nothing is assumed of the noise but that Y is stationary, has a
/// variance, and forgets within M/B coefficients.
///
/// Y is summed in up to 1,024 batches first. Above half length 8 every m/8-th coefficient is used: coefficients that
/// stand closer are nearly equal, unless a rough noise rules the scale, which whoever compares with a model must allow
/// for (HaarCovariance::thinned_sums).
#include "core/signal/progress.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// The most projections of one scale.
inline constexpr std::size_t kMostProjections = 192;

struct SquareProjections {
  std::vector<std::size_t> half;
  std::vector<double> mean;  ///< of Y per scale [unit^2]
  /// L_k/sqrt(M) over the mean of Y: kMostProjections x scales. The mean of the first B squares of a column is the
  /// relative variance of that scale's wavelet variance, the mean product of two columns their relative covariance.
  Eigen::MatrixXd relative;
};

/// Scales m = 1, 2, 4, ... up to `largest_half`, with 100 largest_half <= samples. `samples` are free of NaN and
/// bounded; `pivot` is near their mean. O(N) time for all scales together (about six reads) and N/2 doubles of memory.
/// Without scales if a stop was requested through `control.stop`.
[[nodiscard]] SquareProjections square_projections(std::span<const double> samples, double pivot,
                                                   std::size_t largest_half, const RunControl& control = {});

}  // namespace driftlab
