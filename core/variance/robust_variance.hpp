#pragma once
/// Haar wavelet variance that a few gross errors do not move, from wavelet coefficients and a bounded square.
///
/// nu solves mean chi(W_t/sqrt nu) = E chi(Z), where chi is the biweight of biweight.hpp. At each scale it is tuned to
/// an efficiency of 0.6, given the correlation of the overlapping coefficients under the model-free mixture. The
/// equation is redescending and may have several roots: the largest is taken, and a scale without a root is undefined.
/// There is no root once most windows hold an outlier, which with 1 % of gross errors happens from n = 32 on.
///
/// Every m/8-th coefficient is used, which raises the variance of the estimate by 1.5 %. All of them are used where
/// quantization noise makes up a fiftieth of the scale's variance, because its coefficients are independent one sample
/// apart.
///
/// The estimate is consistent for Gaussian noise, and for the two other clean shapes of robust_shape.hpp (uniform
/// quantization errors, a coarse lattice) when it is told of them. For noise of any other shape it estimates the scale
/// of the core of the distribution, which differs from the variance although nothing is wrong with the data.
#include "core/signal/progress.hpp"
#include "core/variance/biweight.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/robust_shape.hpp"
#include "core/variance/variance_intervals.hpp"

#include <optional>
#include <span>
#include <vector>

namespace driftlab {

struct RobustVariance {
  std::vector<std::optional<double>> variance;  ///< empty: the equation has no root at this scale
  std::vector<double> efficiency;               ///< against the classical variance, by the expansion
  std::vector<double> edf;                      ///< classical edf times efficiency
  std::vector<Interval> ci95;                   ///< {0, 0} where undefined
  std::vector<Biweight> biweight;
  std::vector<std::size_t> stride;  ///< every so many-th coefficient was used
  RobustShape shape;                ///< what was corrected for
};

/// `samples` and `pivot` are as for haar_variance(). A refused shape leaves every scale undefined. The cost is O(N)
/// time per scale up to n = 16 and less above, and N doubles of memory. `control.stop` is polled before every pass over
/// the data; a stopped call gives an estimate without scales.
[[nodiscard]] RobustVariance robust_variance(std::span<const double> samples, double pivot, const HaarVariance& curve,
                                             const VarianceIntervals& classical, HaarCovariance& plan,
                                             RobustShape shape = {}, const RunControl& control = {});

/// The result at one scale: the largest root of mean chi = `expected`, if there is one, and the mean square that it
/// replaces.
struct RobustRoot {
  std::optional<double> variance;
  double mean_square = 0.0;
};

/// The coefficients of one scale, every `stride`-th of them. `prefix`: prefix_sums() of the samples, 2 half < size.
struct ScaleCoefficients {
  std::span<const double> prefix;
  std::size_t half = 1;
  std::size_t stride = 1;
};

/// The stride of half length m where neighbouring coefficients are alike: m/8.
[[nodiscard]] std::size_t smooth_stride(std::size_t half);

/// mean chi(W/sqrt nu) at one scale.
[[nodiscard]] double mean_biweight(const ScaleCoefficients& coefficients, const Biweight& biweight, double nu);

[[nodiscard]] RobustRoot robust_root(const ScaleCoefficients& coefficients, const Biweight& biweight, double expected,
                                     const RunControl& control = {});

}  // namespace driftlab
