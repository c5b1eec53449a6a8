#pragma once
/// The wavelet variances of one channel in the three forms that its characterisation needs.
///
/// Classical: from the samples. Where some are missing, from series that are completed without regard to gross errors;
/// at scales where most windows touch no gap, the windows that touch one are dropped instead. The degrees of freedom
/// are lowered by what the gaps cost. Robust: from the wavelet coefficients while no sample is flagged as a gross
/// error, and sample by sample (core/fit/sample_wise_variance.hpp) as soon as one is. Fitted, that is, those to which
/// models are fitted: the robust ones if the verdict of the contamination test is `contaminated`, with a covariance
/// raised by their lower efficiency; otherwise the classical ones.
#include "core/fit/characterisation.hpp"
#include "core/signal/gappy_samples.hpp"
#include "core/signal/progress.hpp"
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/haar_covariance.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/robust_shape.hpp"
#include "core/variance/variance_intervals.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

/// Wavelet variances in units of `unit_square`.
struct ClassicalVariances {
  HaarVariance curve;
  std::vector<double> efficiency;  ///< per scale, of the gaps; empty: nothing is missing
  std::vector<double> completed;   ///< a series without gaps; empty: nothing is missing
  double unit_square = 1.0;        ///< the largest variance [sample unit^2]
};

/// `rows` are the samples of a channel without gaps, `grid` those of one with gaps. Errors: TooFewSamples if the gaps
/// leave too little; Cancelled.
[[nodiscard]] Result<ClassicalVariances> classical_variances(std::span<const double> rows, double mean,
                                                             const GappySamples& grid, double dt_s, std::uint64_t seed,
                                                             const RunControl& control = {});

/// The shape that clean noise of this channel has for the coefficient-wise estimator: that of a coarse lattice, of
/// uniform quantization errors, or Gaussian. `intervals` are those of the classical curve in units of `unit_square`.
[[nodiscard]] RobustShape clean_shape(std::span<const double> samples, double unit_square,
                                      const VarianceIntervals& intervals, HaarCovariance& plan, std::uint64_t seed,
                                      const RunControl& control = {});

struct RobustVariances {
  std::vector<std::optional<double>> variance;  ///< in units of the classical ones
  std::vector<Interval> ci95;
  std::vector<double> efficiency;
  bool sample_wise = false;
  Contamination contamination;
  std::vector<std::string> warnings;
};

/// Both robust estimators and the contamination test. `samples` is the record, or its completion if it has gaps. The
/// result holds no value if a stop was requested through `control.stop`.
[[nodiscard]] RobustVariances robust_variances(std::span<const double> samples, double mean, const GappySamples& grid,
                                               const ClassicalVariances& classical, const VarianceIntervals& intervals,
                                               HaarCovariance& plan, std::uint64_t seed,
                                               const RunControl& control = {});

/// The data of a model fit: wavelet variances, their standard deviations, and what gives their covariance.
struct FittedVariances {
  std::vector<double> variance;
  Eigen::VectorXd sd;
  std::vector<double> efficiency;  ///< empty: 1
  NoiseShape shape;                ///< kurtosis of the noise; that of robust variances is Gaussian
  Model mixture;                   ///< of dictionary processes, which describes the curve
  bool robust = false;
  ScatterCorrection scatter = {};  ///< of the classical variances, where the record scatters more than linear noise

  /// Covariance of the variances under a model, the mixture or a fit: that of a complete record, with each standard
  /// deviation divided by the square root of its efficiency. `plan` must be that of the scales.
  [[nodiscard]] Eigen::MatrixXd covariance(HaarCovariance& plan, const Model& model) const;
};

/// The robust variances if the channel is contaminated and every scale has a robust value; else the classical ones.
[[nodiscard]] FittedVariances fitted_variances(const ClassicalVariances& classical, const VarianceIntervals& intervals,
                                               const RobustVariances& robust, HaarCovariance& plan);

/// Lowers the degrees of freedom by an efficiency per scale and widens the intervals accordingly. An empty `efficiency`
/// changes nothing.
void lower_degrees(const std::vector<double>& efficiency, const HaarVariance& curve, VarianceIntervals& intervals);

}  // namespace driftlab
