#pragma once
/// Samples on a coarse lattice: how rounding to multiples of a step biases the robust variance, and its correction.
///
/// For rounded white noise the biweight estimates the variance of the rounded values within 1 % as long as the noise
/// has a standard deviation of 0.6 steps or more. At 0.5 steps it is 0-10 % too small, at 0.4 it is close to zero, and
/// at 0.3 the estimating equation has no root, because nearly all coefficients then take one of three values.
///
/// The correction simulates the rounded model and replaces E chi in the estimating equation by its mean over the
/// simulated records, with a wider biweight. The remaining bias of ln(robust/classical), and its additional scatter,
/// are taken from the same simulations. The model is obtained as follows. The standard deviation before rounding and
/// the position on the lattice follow from a probit regression on how often each value occurs: the normal quantile z of
/// the share of samples at or below a value is linear in that value, with slope 1/sd. The slow part is that of the
/// fitted mixture. Below 0.35 steps the result depends almost entirely on the position, so no robust value is given.
#include "core/variance/robust_shape.hpp"
#include "core/variance/variance_intervals.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace driftlab {

/// The lattice step: at least 98 % of the differences between successive samples are multiples of it.
/// Nothing if there is none, or if it does not show because most differences are more than a few steps. O(N).
[[nodiscard]] std::optional<double> lattice_step(std::span<const double> samples);

/// Position and spread of the noise before rounding, in steps.
struct LatticeNoise {
  double sd = 0.0;
  double offset = 0.0;  ///< of the level from the nearest lattice value; mean over the record, -0.5 .. 0.5
  bool fixed = false;   ///< the level stays within a tenth of a step over the record
};

/// Probit regression with one slope, and one offset per stretch of `stretch` samples. Gross errors should be left out
/// of `samples`. Nothing if no stretch holds three values in usable numbers, or if a stop was requested through
/// `control.stop`, which is polled once per stretch. O(N).
[[nodiscard]] std::optional<LatticeNoise> lattice_noise(std::span<const double> samples, double step,
                                                        std::size_t stretch, const RunControl& control = {});

/// Limits on the standard deviation of the noise in steps. Below the first the shape is obtained by simulation; below
/// the second no robust value is given.
inline constexpr double kCoarseLattice = 0.8;
inline constexpr double kTooCoarseLattice = 0.35;

/// The shape of a record on a lattice; empty if the record lies on no lattice or on a fine one. 32 records of at most
/// 16,384 samples are simulated. `intervals` and `plan` belong to the record's classical curve, whose variances are in
/// units of `unit_square` (samples squared). The same seed gives the same bits. Empty if a stop was requested through
/// `control.stop`.
[[nodiscard]] RobustShape lattice_shape(std::span<const double> samples, double unit_square,
                                        const VarianceIntervals& intervals, HaarCovariance& plan, std::uint64_t seed,
                                        const RunControl& control = {});

}  // namespace driftlab
