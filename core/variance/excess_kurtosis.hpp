#pragma once
/// How far the noise is from Gaussian, and how that widens the scatter of an estimated wavelet variance.
///
/// For linear noise whose innovations have excess kurtosis k4, the relative variance of the estimate nu^_j grows by k4
/// T_j/(M_j L_j)^2. Here L = 2m is the filter length, M the number of coefficients, and T the sum of squares of the
/// overlap of a box of L samples with a box of M coefficients. The term tends to k4 N/M_j^2, which is the same at every
/// scale; it therefore matters most where the equivalent degrees of freedom are many.
#include "core/process/model.hpp"
#include "core/signal/progress.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace driftlab {

/// Excess kurtosis of the first differences of the samples. It is set to 0 if it lies within two standard errors of the
/// Gaussian value 0; the standard error is sqrt(24/N), doubled because neighbouring differences are correlated. The
/// samples are read once; at least 3 are needed. The result is 0 for a constant series, and if a stop was requested
/// through `control.stop` (polled every million samples).
[[nodiscard]] double difference_excess_kurtosis(std::span<const double> samples, const RunControl& control = {});

/// T_j/(M_j L_j)^2 for half length m: the relative variance per unit of excess kurtosis.
[[nodiscard]] double kurtosis_share(std::size_t half, std::size_t samples);

/// The excess kurtosis of the innovations of one part of a model, either its rough or its smooth part (part_variance).
struct NoiseShape {
  double kurtosis = 0.0;  ///< 0: Gaussian
  bool rough = true;
};

/// Wavelet variance of one part of a model. The rough part (`rough`) consists of the processes that first differences
/// do not whiten further: quantization, white and flicker noise, and Gauss-Markov processes with beta dt >= 0.3. The
/// smooth part is the rest.
[[nodiscard]] double part_variance(const Model& model, double half, double dt_s, bool rough);

/// Adds k4 a_i a_j sqrt(share_i share_j) to the covariance of the wavelet variances [unit^4], where a is the wavelet
/// variance of the part of the model that `shape` describes. A negative kurtosis is limited so that the variance in no
/// direction shrinks by more than nine tenths.
void add_kurtosis(Eigen::MatrixXd& covariance, const Model& model, std::span<const double> half, std::size_t samples,
                  double dt_s, const NoiseShape& shape);
/// The same for a part whose wavelet variances are given, one per half length.
void add_kurtosis(Eigen::MatrixXd& covariance, const Eigen::VectorXd& part, std::span<const std::size_t> half,
                  std::size_t samples, double kurtosis);

}  // namespace driftlab
