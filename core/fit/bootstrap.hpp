#pragma once
/// Parametric bootstrap of parameter intervals: simulation of how far the quasi-likelihood rises at the true value.
///
/// The profile interval of a parameter holds the values at which L (log_fit.hpp) exceeds its minimum by at most c. In
/// the Gaussian limit c = 3.84; near a bound, or at scales of a few degrees of freedom, that need not hold. Here c is
/// the 95 % quantile of the rise of L in series simulated from the fit itself. Each series has its own wavelet
/// variances and its own minimum, and the rise is evaluated at the parameter value from which the series was simulated
/// (Hall 1992, ch. 3: bootstrap calibration of a pivot). Percentiles of the estimates are not used: their intervals
/// cover 69 to 100 % here. The covariance stays that of the curve;
/// where it has a discrepancy, one is drawn for each scale too. Processes are simulated as declared: Gaussian, except
/// for quantization errors, which are uniform.
#include "core/fit/candidate.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace driftlab {

inline constexpr std::size_t kFewestReplicates = 40;
inline constexpr std::size_t kMostReplicates = 2000;

/// The error for a number of replicates outside these bounds.
[[nodiscard]] Error replicates_error(std::size_t replicates);

/// The rise c of each coordinate of `candidate.log_fit`, in their order. Replicate r draws from stream r of `seed`.
/// `moments` must be those of the fit, at all octaves of one recording. Errors: InvalidArgument (fewer than 40 or more
/// than 2,000 replicates, a candidate without a fit, a stack of recordings), Cancelled (polled before each replicate).
/// Each replicate costs one simulated series and one minimisation per parameter, some 10 ms at N = 90,000.
[[nodiscard]] Result<std::vector<double>> bootstrap_rises(const Candidate& candidate, const WaveletMoments& moments,
                                                          std::size_t replicates, std::uint64_t seed,
                                                          const RunControl& control = {});

}  // namespace driftlab
