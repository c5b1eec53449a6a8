#pragma once
/// Random draws of the complete, clean series: the one that would have been recorded without gaps and gross errors,
/// given the recorded data.
///
/// The good samples s follow a Gaussian model with linear states (linear_states.hpp). A sample is either missing, or
/// recorded correctly as y = s, or recorded as y = s + o with a gross error o of one of several sizes
/// (outlier_mixture.hpp).
///
/// One sweep is one step of a Gibbs sampler. It first runs backward in time and collects the information about the
/// states in all later samples (the information form of the Kalman filter, with each sample's present state). It then
/// runs forward, sample by sample, with the law of s_t given all later samples and the *completed* earlier ones. From
/// this law it draws whether y_t carries a gross error, and it draws s_t itself if y_t is missing or carries one. Each
/// step preserves the joint law of states and series, so after a few sweeps the completed series is a draw from that
/// law (partially collapsed Gibbs sampling; cf. Gerlach, Carter and Kohn 2000). Its wavelet variances have the same
/// expectation as those of the true series: nothing is interpolated, and no truncation needs correction.
///
/// The forward gains become constant after a short time, because the past is complete. The backward precision does so
/// in a run of good samples: within 1e-7 of that of an endless run it is taken as it, and one matrix, N x N, then moves
/// the information over a sample. The cost is O(N) time and some 2 x 2048 states of memory beyond the arguments: the
/// backward information is kept at the ends of blocks and recomputed inside a block.
#include "core/fit/linear_states.hpp"
#include "core/fit/outlier_mixture.hpp"
#include "core/process/random.hpp"
#include "core/signal/progress.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace driftlab {

/// State of a sample.
inline constexpr std::uint8_t kGoodSample = 0;       ///< k + 1: carries an error of size k of the mixture
inline constexpr std::uint8_t kAbsentSample = 0xFF;  ///< no value; stays absent

/// What a sweep works on, one entry per grid point.
struct CompletionArrays {
  std::span<const double> recorded;  ///< anything where absent
  std::span<std::uint8_t> state;     ///< in and out
  std::span<double> completed;       ///< out: the drawn series
  std::span<float> residual;  ///< out: e/sqrt(V) of recorded samples given all others, 0 where absent; may be empty
};

struct CompletionLaw {
  LinearStates states;
  /// The sizes of gross errors and `core`, relative to `unit`. Without sizes no gross errors are looked for.
  OutlierMixture mixture;
  double unit = 1.0;   ///< variance that z = 1 stands for: leave_one_out_variance of the states the mixture came from
  double pivot = 0.0;  ///< level that the recorded samples are taken relative to
};

/// One sweep. The residuals of the recorded samples, in units of `unit`, are added to `histogram`. The result is
/// determined by the state of the generator. The sweep is abandoned if a stop was requested through `control.stop`,
/// which is polled every 2,048 samples.
void sweep_completion(const CompletionLaw& law, const CompletionArrays& arrays, Random& random,
                      ResidualHistogram& histogram, const RunControl& control = {});

}  // namespace driftlab
