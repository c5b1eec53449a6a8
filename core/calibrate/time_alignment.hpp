#pragma once
/// The delay between a measured channel and its reference, to a fraction of a sample.
///
/// Model: m(t) = a + k r(t - delay) + e(t), with both series on one grid of interval dt. Between its samples r is
/// interpolated by cubic convolution (Keys 1981, a = -1/2: exact for quadratics, error O(dt^3)). e is the error of the
/// sensor, with any spectrum.
///
/// The estimate is by least squares over (a, k, delay): first the best whole number of samples within +-max_shift_s by
/// correlation, then Gauss-Newton steps. The 95 % interval comes from the sandwich covariance with the long-run
/// covariance of the scores (prewhitened by one coefficient, Bartlett weights over n^(1/3) lags: Andrews and Monahan
/// 1992), so that correlated errors widen it. Only a moving reference can be aligned: its information on the delay is
/// sum (k r')^2.
///
/// A noisy reference biases the estimate. Interpolation smooths its noise most halfway between samples, so the fit
/// prefers or avoids fractions near a half. The effect is not noticeable if the noise of the reference is below a tenth
/// of that of the sensor.
#include "core/signal/estimate.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

struct AlignmentOptions {
  double max_shift_s = 2.0;
};

struct TimeAlignment {
  Estimate delay_s;           ///< the channel shows at t what the reference showed at t - delay
  double gain = 1.0;          ///< k
  double offset = 0.0;        ///< a [unit of the channel]
  double residual_rms = 0.0;  ///< of e [unit of the channel]
  double correlation = 0.0;   ///< of the channel and the aligned reference
  std::size_t samples = 0;    ///< compared
  bool converged = false;
  std::vector<std::string> warnings;
};

/// Errors: ShapeMismatch (unequal lengths), TooFewSamples (below 16 beside the largest shift), NonFinite,
/// InvalidArgument (dt or shift not positive, a reference or channel that does not move). O(n * shifts) for the whole
/// samples, O(n) a step after that.
[[nodiscard]] Result<TimeAlignment> align_reference(std::span<const double> measured, std::span<const double> reference,
                                                    double dt_s, const AlignmentOptions& options = {});

/// r(t - delay) on the grid of r; beyond its ends the nearest sample that can be interpolated. O(n).
[[nodiscard]] std::vector<double> delayed(std::span<const double> series, double delay_samples);

}  // namespace driftlab
