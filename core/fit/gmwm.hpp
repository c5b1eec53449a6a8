#pragma once
/// Generalised method of wavelet moments (GMWM): the estimator that brings the wavelet variances implied by a model as
/// close as possible to the estimated ones.
///
/// theta^ = argmin (nu^ - nu(theta))' W (nu^ - nu(theta)) (Guerrier, Skaloud, Stebler, Molinari 2013; seed paper eq.
/// 7). For given shape parameters (beta, frequency) the model is linear in the squared levels, so these are found
/// exactly, by enumerating which of them are positive. The shape parameters are found by a scan of their whole range,
/// followed by Levenberg-Marquardt iterations with analytic derivatives of the projected residual (Golub and Pereyra
/// 1973; Kaufman 1975). No starting values are needed and nothing is random.
#include "core/process/model.hpp"

#include <Eigen/Core>

#include <span>
#include <vector>

namespace driftlab {

/// The estimated wavelet variances and the scales they belong to. They are those of one recording, or those of several
/// recordings stacked one below the other (core/campaign/replicates.hpp); every estimator here treats both alike.
struct WaveletMoments {
  Eigen::VectorXd nu;
  std::vector<double> half;           ///< half lengths m
  double samples = 0.0;               ///< of the longest recording; sets the search range of a shape parameter
  double dt_s = 0.0;                  ///< of the finest recording
  std::vector<double> row_dt_s = {};  ///< sample interval of each entry of a stack; empty: dt_s throughout

  /// Consecutive rows that have the half lengths and sample interval of those that begin at `like`, at or before them.
  struct Stretch {
    std::size_t first = 0;
    std::size_t rows = 0;
    std::size_t like = 0;
  };
  /// The recordings of a stack: what a model implies is the same for all of one kind. Empty: one recording.
  std::vector<Stretch> stretches = {};

  [[nodiscard]] double dt_at(std::size_t row) const { return row_dt_s.empty() ? dt_s : row_dt_s[row]; }
};

/// The weights W = A'A of the estimator, by the A that they are applied with.
class MomentWeights {
 public:
  /// W = diag(1/sd^2).
  [[nodiscard]] static MomentWeights from_sd(const Eigen::VectorXd& sd);
  /// W = covariance^-1; where rounding leaves the matrix indefinite its diagonal is raised until it is not.
  [[nodiscard]] static MomentWeights from_covariance(const Eigen::MatrixXd& covariance);

  /// A v.
  [[nodiscard]] Eigen::VectorXd whitened(const Eigen::VectorXd& v) const;
  [[nodiscard]] Eigen::MatrixXd whitening() const;

 private:
  Eigen::VectorXd diagonal_;  ///< of a diagonal A; empty: `whole_`
  Eigen::MatrixXd whole_;
};

struct GmwmSolution {
  Model model;  ///< one entry per process of the structure; a level of 0: the component vanished
  double objective = 0.0;
  bool converged = false;
  /// The processes with a positive level.
  [[nodiscard]] Model active() const;
};

/// The cost is 48 points per shape parameter: at 20 scales about 0.2 ms for one shape and 5 ms for two.
[[nodiscard]] GmwmSolution fit_gmwm(const WaveletMoments& moments, const ModelStructure& structure,
                                    const MomentWeights& weights);

/// Puts processes of one kind into a fixed order: the largest shape (fastest) first, vanished ones last.
void sort_repeats(Model& model);

/// Wavelet variances of a process of these parameters at every row, and unless `gradient` is empty their derivatives by
/// each parameter, rows x parameters, row by row.
void curve_of(const ProcessKind& kind, std::span<const double> parameters, const WaveletMoments& moments,
              std::span<double> variance, std::span<double> gradient = {});

/// nu(theta) of a model at every scale.
[[nodiscard]] Eigen::VectorXd modelled_variance(const WaveletMoments& moments, const Model& model);

}  // namespace driftlab
