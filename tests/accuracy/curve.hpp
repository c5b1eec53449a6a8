#pragma once
/// The curve of a simulated series, ready to be fitted.
#include "core/fit/channel_variances.hpp"
#include "core/fit/curve_covariance.hpp"
#include "core/fit/gmwm.hpp"
#include "core/variance/excess_kurtosis.hpp"
#include "core/variance/haar_covariance.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/samples.hpp"
#include "core/variance/variance_intervals.hpp"

#include <Eigen/Core>

#include <vector>

namespace driftlab::accuracy {

struct SimulatedCurve {
  WaveletMoments moments;
  Eigen::VectorXd sd;
  Eigen::MatrixXd covariance;  ///< of the variances under the mixture
  CurveCovariance logarithms;
  FittedVariances fitted;
};

/// `plan` is that of all octaves of the series; variances in units of `unit_square`.
inline SimulatedCurve curve_of(const std::vector<double>& x, HaarCovariance& plan, double unit_square = 1.0) {
  HaarVariance curve = haar_variance(x, summarise(x)->mean);
  for (double& variance : curve.variance) {
    variance /= unit_square;
  }
  const VarianceIntervals intervals = variance_intervals(curve, plan, difference_excess_kurtosis(x));
  const FittedVariances fitted{
      curve.variance, intervals.estimate_variance.cwiseSqrt(), {}, intervals.shape, intervals.mixture, false};
  SimulatedCurve result;
  result.moments = {Eigen::Map<const Eigen::VectorXd>(curve.variance.data(), static_cast<Eigen::Index>(curve.scales())),
                    {plan.half().begin(), plan.half().end()},
                    static_cast<double>(x.size()),
                    plan.dt_s()};
  result.sd = fitted.sd;
  result.covariance = fitted.covariance(plan, fitted.mixture);
  result.logarithms =
      curve_covariance(result.moments.nu, modelled_variance(result.moments, fitted.mixture), result.covariance);
  result.fitted = fitted;
  return result;
}

}  // namespace driftlab::accuracy
