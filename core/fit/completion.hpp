#pragma once
/// Draws of the series that would have been recorded without gaps and gross errors, from its law given the data.
///
/// Good samples s follow a Gaussian model with linear states (linear_states.hpp). A sample is absent, or recorded as
/// y = s, or as y = s + o with an error o of one of several sizes (outlier_mixture.hpp). One sweep is one step of a
/// Gibbs sampler: backward in time the information about the states in all later samples (the information form of the
/// Kalman filter, with each sample's present state); forward in time, sample by sample, the law of s_t given all later
/// samples and the *completed* earlier ones, from which whether y_t carries an error is drawn, and s_t where it is
/// absent or does. Each step keeps the joint law of states and series, so that after a few sweeps a completed series is
/// a draw from it (partially collapsed Gibbs sampling; cf. Gerlach, Carter and Kohn 2000), and its wavelet variances
/// have the expectation of those of the true series: no interpolation, no truncation to correct for.
///
/// The completed past makes the forward gains constant after a short time. O(N) time, some 2 x 2048 states of memory
/// beyond the arguments: the backward information is kept at block ends and recomputed inside a block.
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
  /// Sizes relative to `unit`, as is `core`; no sizes: gross errors are not looked for.
  OutlierMixture mixture;
  double unit = 1.0;   ///< variance that z = 1 stands for: leave_one_out_variance of the states the mixture came from
  double pivot = 0.0;  ///< level that the recorded samples are taken relative to
};

/// One sweep. `histogram`: of the residuals of recorded samples, in units of `unit`, added to.
/// Deterministic in the generator's state. Broken off where `control.stop` asked, which is polled every 2,048 samples.
void sweep_completion(const CompletionLaw& law, const CompletionArrays& arrays, Random& random,
                      ResidualHistogram& histogram, const RunControl& control = {});

}  // namespace driftlab
