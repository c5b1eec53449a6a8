#pragma once
/// Haar wavelet variances of the good samples of a record that has gaps, gross errors, or both.
///
/// (1) outlier_screen.hpp marks the suspect samples. (2) WN+RW, or WN+RW with QN and GM if these fit much better, is
/// fitted to the wavelet variances of the provisional series. (3) Sweeps of completion.hpp follow, each with a new fit
/// and new shares of gross errors, until both have settled. The result is the average of the classical wavelet
/// variances of several drawn series. A drawn series follows the law of the true series given the data, so its
/// variances are unbiased at every scale if the model is right; if few samples are replaced, the model hardly matters.
/// If there are gaps but no gross errors, the windows that touch a gap are dropped at scales where three quarters of
/// the windows are whole, which needs no model at all.
///
/// Assumptions: good samples are Gaussian and follow a model of these processes; errors add to single samples
/// independently of the noise; patches of shifted samples are found by the screen and treated as gaps. If more than 20
/// % of the samples deviate, the core of the distribution is not Gaussian, no robust value is defined, and no result is
/// given.
#include "core/process/model.hpp"
#include "core/signal/gappy_samples.hpp"
#include "core/signal/progress.hpp"
#include "core/variance/haar_covariance.hpp"
#include "core/variance/haar_variance.hpp"

#include <cstdint>
#include <vector>

namespace driftlab {

enum class SampleWiseOutcome {
  Estimated,
  NotGaussian,    ///< more than a fifth of the samples deviate
  TooFewSamples,  ///< fewer than 16 recorded, or more than two missing for each
  Degenerate,     ///< more than half of the samples are equal to their neighbours: there is no noise to model
  Cancelled       ///< the token asked; it is polled every few milliseconds
};

struct SampleWiseOptions {
  std::uint64_t seed = 1;
  bool look_for_errors = true;  ///< false: only gaps are filled
  std::size_t draws = 0;        ///< 0: five, or two from 300,000 samples on
};

struct SampleWiseVariance {
  SampleWiseOutcome outcome = SampleWiseOutcome::Estimated;
  HaarVariance curve;  ///< of the grid; mean over the draws
  /// Per scale, the variance of the classical estimate on the true series over the variance of this estimate. It
  /// follows from the scatter among the draws (Rubin 1987).
  std::vector<double> efficiency;
  std::vector<std::size_t> flagged;  ///< grid points whose error passes a false-discovery rate of 1 %, and patches
  double replaced_share = 0.0;       ///< recorded samples that a draw replaces, mean over draws
  Model model;                       ///< the last fit
  std::vector<double> completed;     ///< the last drawn series
};

/// `plan`: of the grid's scales. O(N) time: some 0.8 us a sample at 10^6. Same seed, same bits.
[[nodiscard]] SampleWiseVariance sample_wise_variance(const GappySamples& samples, HaarCovariance& plan,
                                                      const SampleWiseOptions& options = {},
                                                      const RunControl& control = {});

}  // namespace driftlab
