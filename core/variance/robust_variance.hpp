#pragma once
/// Haar wavelet variance that a few gross errors do not move: coefficient by coefficient, with a bounded square.
///
/// nu solves mean chi(W_t/sqrt nu) = E chi(Z), chi of biweight.hpp tuned per scale to an efficiency of 0.6 for the
/// overlap of the coefficients under the model-free mixture. The equation is redescending: the upper root is taken, and
/// a scale without one is undefined (once most windows hold an outlier there is none: 1 % of gross errors, from n = 32
/// on). Every m/8-th coefficient is used (1.5 % more variance);
/// all of them where quantization noise makes up a fiftieth of the scale, for its coefficients are independent one
/// sample apart. Consistent for Gaussian noise, and for the two other clean shapes that robust_shape.hpp knows (uniform
/// quantization errors, a coarse lattice) where told of them; for noise of yet another shape it estimates the scale of
/// its core, which differs from the variance without anything being wrong.
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

/// `samples`, `pivot`: as for haar_variance(). A refused shape leaves every scale undefined. O(N) time per scale up to
/// n = 16, less above; N doubles of memory. `control.stop` is polled before every look at the data; a stopped call
/// gives an estimate without scales.
[[nodiscard]] RobustVariance robust_variance(std::span<const double> samples, double pivot, const HaarVariance& curve,
                                             const VarianceIntervals& classical, HaarCovariance& plan,
                                             RobustShape shape = {}, const RunControl& control = {});

/// One scale: the largest root of mean chi = `expected`, if there is one, beside the mean square it stands against.
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
