#pragma once
/// Generalised method of wavelet moments: the model whose Haar wavelet variances lie nearest the estimated ones.
///
/// theta^ = argmin (nu^ - nu(theta))' W (nu^ - nu(theta)) (Guerrier, Skaloud, Stebler, Molinari 2013; seed paper eq.
/// 7). For given shapes (beta, frequency) the model is linear in the squared levels, so these are found exactly by
/// enumerating which of them are positive; the shapes are found by a scan of their whole range and a
/// Levenberg-Marquardt polish with analytic derivatives of the projected residual (Golub and Pereyra 1973; Kaufman
/// 1975). No starting values, nothing random.
#include "core/process/model.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace driftlab {

/// The estimated wavelet variances and the grid they belong to: one recording's, or those of several stacked one below
/// the other (core/campaign/replicates.hpp), which every estimator here takes alike.
struct WaveletMoments {
  Eigen::VectorXd nu;
  std::vector<double> half;           ///< half lengths m
  double samples = 0.0;               ///< of the longest recording: what the search range of a shape is taken from
  double dt_s = 0.0;                  ///< of the finest recording
  std::vector<double> row_dt_s = {};  ///< sample interval of each entry of a stack; empty: dt_s throughout

  [[nodiscard]] double dt_at(std::size_t row) const { return row_dt_s.empty() ? dt_s : row_dt_s[row]; }
};

/// W = whitening' whitening.
struct MomentWeights {
  Eigen::MatrixXd whitening;

  /// W = diag(1/sd^2).
  [[nodiscard]] static MomentWeights from_sd(const Eigen::VectorXd& sd);
  /// W = covariance^-1; where rounding leaves the matrix indefinite its diagonal is raised until it is not.
  [[nodiscard]] static MomentWeights from_covariance(const Eigen::MatrixXd& covariance);
};

struct GmwmSolution {
  Model model;  ///< one entry per process of the structure; a level of 0: the component vanished
  double objective = 0.0;
  bool converged = false;
  /// The processes with a positive level.
  [[nodiscard]] Model active() const;
};

/// Cost: 48 points per shape; about 0.2 ms for one, 5 ms for two shapes at 20 scales.
[[nodiscard]] GmwmSolution fit_gmwm(const WaveletMoments& moments, const ModelStructure& structure,
                                    const MomentWeights& weights);

/// nu(theta) of a model at every scale.
[[nodiscard]] Eigen::VectorXd modelled_variance(const WaveletMoments& moments, const Model& model);

}  // namespace driftlab
