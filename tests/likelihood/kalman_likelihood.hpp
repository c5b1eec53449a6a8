#pragma once
/// Exact Gaussian likelihood of a composite model, by the Kalman filter: what the tests hold the GMWM, its ranking and
/// the state spaces of the processes against. No part of the product.
///
/// Model: y_t = c + s (t - middle) dt + sum of the model's processes, each in the state space that it declares
/// (core/process/state_space.hpp; Durbin and Koopman 2012, ch. 2, 4 and 7). The constant c, which no wavelet variance
/// depends on, and the slope s of a linear drift are estimated by generalised least squares inside the filter. The
/// likelihood is the profile over them:
///
///   ln L = -1/2 sum_t [ln(2 pi S_t) + e_t^2/S_t],  with e_t the innovations at that c and s.
///
/// A random walk starts at 0, since its unknown start is part of c; stationary processes start in their stationary
/// distribution. The value R that the model carries for a drift is not used; the estimated slope is reported. Processes
/// that are not Gaussian (uniform quantization errors, a sinusoid of random phase) enter through the Gaussian model of
/// the same second moments, which makes this a quasi-likelihood. Flicker noise enters through its approximate state
/// space, whose error is returned as `relative_error`.
///
/// A sample that is NaN is missing: the filter predicts across it, and nothing is assumed about its value.
#include "core/process/model.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <span>

namespace driftlab {

struct KalmanLikelihood {
  double log_likelihood = 0.0;  ///< natural logarithm, at `mean` and `slope`
  /// The same with all levels multiplied by the one factor that suits the data best, sqrt(scale).
  double scaled_log_likelihood = 0.0;
  double scale = 1.0;           ///< mean of e_t^2/S_t: 1 where the levels are right
  double mean = 0.0;            ///< c, at the middle of the record [unit]
  double mean_sd = 0.0;         ///< its standard error under the model [unit]
  double slope = 0.0;           ///< s [unit/s]; 0 where the model has no linear drift
  double slope_sd = 0.0;        ///< [unit/s]
  std::size_t samples = 0;      ///< that are not missing
  double relative_error = 0.0;  ///< of the spectral density of the state space used; 0 where exact
};

/// `samples` are uniform at dt_s [unit], NaN where missing. Errors: InvalidArgument (no process, dt_s not positive, a
/// process without state space, no noise at all), TooFewSamples (fewer than 3 that are not missing), OutOfRange (the
/// innovation variance vanishes or overflows), Cancelled (polled every 65,536 samples). The cost is O(N d^2) until the
/// gain has converged and O(N d) afterwards, with d the number of states: some 10 ns per sample for WN+2GM+RW. After a
/// gap the gain has to converge again. Flicker noise has 16 states. With pure quantization noise the gain never
/// converges.
[[nodiscard]] Result<KalmanLikelihood> kalman_likelihood(std::span<const double> samples, const Model& model,
                                                         double dt_s, const RunControl& control = {});

/// -2 ln L + parameters ln N, the criterion of Schwarz (1978): smaller is better. `parameters` counts those of the
/// model, the slope of a drift included; the constant is common to all models and is not counted.
[[nodiscard]] double bayesian_criterion(double log_likelihood, std::size_t parameters, std::size_t samples);

struct LikelihoodFit {
  Model model;                  ///< R of a drift: the magnitude of the slope found
  KalmanLikelihood likelihood;  ///< at `model`
  int evaluations = 0;
  bool converged = false;
};

/// Maximum likelihood, starting from `start` (for instance the GMWM estimate). Quasi-Newton steps (BFGS) are taken on
/// the logarithms of levels and shapes with numerical derivatives; the overall level is found exactly at each step. The
/// search is local: it finds the optimum next to `start`. Processes of level 0 are left out; a level that tends towards
/// zero stays in the model with a tiny value. Errors: those of kalman_likelihood. The cost is some 20 (p + 1) to 60 (p
/// + 1) evaluations for p parameters.
[[nodiscard]] Result<LikelihoodFit> maximise_likelihood(std::span<const double> samples, const Model& start,
                                                        double dt_s, const RunControl& control = {});

}  // namespace driftlab
