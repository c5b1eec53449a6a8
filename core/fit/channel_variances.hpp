#pragma once
/// The wavelet variances of one channel in every form the characterisation needs: classical, robust, and those that
/// models are fitted to.
///
/// Classical: of the samples; where some are missing, of series completed without regard to gross errors (the windows
/// that touch a gap dropped where most do not), their degrees of freedom lowered by what the gaps cost. Robust:
/// coefficient by coefficient while nothing is flagged; as soon as samples are, sample by sample
/// (core/fit/sample_wise_variance.hpp). Fitted: the robust ones where the contamination test says `contaminated`, with
/// a covariance raised by their lower efficiency.
#include "core/fit/candidate.hpp"
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

/// `samples` without gaps: `rows`; with: `grid`. Errors: TooFewSamples where the gaps leave too
/// little; Cancelled.
[[nodiscard]] Result<ClassicalVariances> classical_variances(std::span<const double> rows, double mean,
                                                             const GappySamples& grid, double dt_s, std::uint64_t seed,
                                                             const RunControl& control = {});

/// What clean noise of this channel looks like to the coefficient-wise estimator: that of a coarse lattice, of uniform
/// quantization errors, or Gaussian. `intervals`: of the classical curve in units of `unit_square`.
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

/// Both robust estimators and the contamination test. `samples`: the record, or its completion where it has gaps.
/// Without a value where `control.stop` asked.
[[nodiscard]] RobustVariances robust_variances(std::span<const double> samples, double mean, const GappySamples& grid,
                                               const ClassicalVariances& classical, const VarianceIntervals& intervals,
                                               HaarCovariance& plan, std::uint64_t seed,
                                               const RunControl& control = {});

/// What models are fitted to: moments, their standard deviations, and their covariance under a model.
struct FittedVariances {
  std::vector<double> variance;
  Eigen::VectorXd sd;
  std::vector<double> efficiency;  ///< empty: 1
  NoiseShape shape;                ///< kurtosis of the noise; that of robust variances is Gaussian
  bool robust = false;

  /// Covariance under a model: that of a whole Gaussian record, each standard deviation over the root of its
  /// efficiency.
  [[nodiscard]] CovarianceLaw covariance(HaarCovariance& plan) const;
};

/// Robust where the channel is contaminated and every scale has a robust value.
[[nodiscard]] FittedVariances fitted_variances(const ClassicalVariances& classical, const VarianceIntervals& intervals,
                                               const RobustVariances& robust, HaarCovariance& plan);

/// Degrees of freedom and intervals lowered by an efficiency per scale; empty: unchanged.
void lower_degrees(const std::vector<double>& efficiency, const HaarVariance& curve, VarianceIntervals& intervals);

}  // namespace driftlab
