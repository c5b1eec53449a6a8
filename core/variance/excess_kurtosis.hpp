#pragma once
/// How far the noise is from Gaussian, and what that does to the scatter of a wavelet variance.
///
/// For linear noise whose innovations have excess kurtosis k4, the relative variance of nu^_j rises by k4 T_j/(M_j
/// L_j)^2 with L = 2m the filter length and T the sum of squares of the overlap of the box of L samples with that of M
/// coefficients (it tends to k4 N/M_j^2: the same amount at every scale, which matters where the equivalent degrees of
/// freedom are many).
#include "core/process/model.hpp"
#include "core/signal/progress.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>

namespace driftlab {

/// Excess kurtosis of the first differences of the samples, 0 where it is within two standard errors (sqrt(24/N),
/// doubled for the correlation of neighbours) of that of a Gaussian. One read. Needs at least 3 samples; 0 for a
/// constant, and where `control.stop` asked (polled every million samples).
[[nodiscard]] double difference_excess_kurtosis(std::span<const double> samples, const RunControl& control = {});

/// T_j/(M_j L_j)^2 for half length m: the relative variance per unit of excess kurtosis.
[[nodiscard]] double kurtosis_share(std::size_t half, std::size_t samples);

/// What is not Gaussian: the excess kurtosis of the innovations of one part of a model, its rough or its smooth one.
struct NoiseShape {
  double kurtosis = 0.0;  ///< 0: Gaussian
  bool rough = true;
};

/// Wavelet variance of the part of a model that first differences whiten no further (`rough`: quantization, white and
/// flicker noise, Gauss-Markov processes with beta dt >= 0.3), or of the rest.
[[nodiscard]] double part_variance(const Model& model, double half, double dt_s, bool rough);

/// Adds k4 a_i a_j sqrt(share_i share_j) to the covariance of the wavelet variances [unit^4], a the variance of the
/// part that `shape` speaks of. A negative kurtosis is taken back so far that nine tenths of no direction's variance
/// go.
void add_kurtosis(Eigen::MatrixXd& covariance, const Model& model, std::span<const double> half, std::size_t samples,
                  double dt_s, const NoiseShape& shape);

}  // namespace driftlab
