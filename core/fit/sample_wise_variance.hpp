#pragma once
/// Haar wavelet variances of the good samples of a record that has gaps, gross errors, or both.
///
/// (1) outlier_screen.hpp says where to start. (2) WN+RW, and QN and GM where these fit much better, is fitted to the
/// wavelet variances of the provisional series. (3) Sweeps of completion.hpp, each followed by a new fit and new shares
/// of gross errors, until both have settled; then the classical wavelet variances of several drawn series, averaged.
/// Since a drawn series follows the law of the true one given the data, its variances are unbiased at every scale where
/// the model is right; where few samples are replaced the model hardly matters. Where gaps are all there is, windows
/// that touch one are dropped at scales at which three quarters of them are whole, which needs no model at all.
///
/// Assumes that good samples are Gaussian around a model of these processes and that errors add to single samples,
/// independently of the noise; patches of shifted samples are found by the screen and treated as gaps. More than 20 %
/// of errors mean that the core is not Gaussian: there is then no truth to be robust for, and no result.
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
  TooFewSamples,  ///< fewer than 16 recorded, or more missing than recorded
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
  /// Var of the classical estimate on the true series over that of this one, per scale: what the draws scatter by
  /// (Rubin 1987).
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
