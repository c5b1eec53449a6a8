#pragma once
/// Samples on a coarse lattice: what rounding to multiples of a step does to a robust variance, and its cure.
///
/// Of rounded white noise the biweight finds the variance of the rounded values within 1 % while the noise has a
/// standard deviation of 0.6 steps or more, 0-10 % too little at 0.5, nearly nothing at 0.4, and no root at 0.3: nearly
/// all coefficients are then one of three values. The cure simulates the rounded model (standard deviation before
/// rounding and position on the lattice by probit regression on how often each value occurs: z of the share of samples
/// at or below a value is linear in it, with slope 1/sd; the slow part from the fitted mixture) and replaces E chi of
/// the estimating equation by its mean over the simulated records, with a wider biweight; what is left of
/// ln(robust/classical), and how much more that scatters, is taken from them too. Below 0.35 steps all hangs on the
/// position: refused.
#include "core/variance/robust_shape.hpp"
#include "core/variance/variance_intervals.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace driftlab {

/// The step of which at least 98 % of the differences between successive samples are multiples, if there is one that
/// shows: most of the steps taken are a few units. O(N).
[[nodiscard]] std::optional<double> lattice_step(std::span<const double> samples);

/// Position and spread of the noise before rounding, in steps.
struct LatticeNoise {
  double sd = 0.0;
  double offset = 0.0;  ///< of the level from the nearest lattice value; mean over the record, -0.5 .. 0.5
  bool fixed = false;   ///< the level stays within a tenth of a step over the record
};

/// Probit regression with one slope and one offset per stretch of `stretch` samples. Nothing where no stretch holds
/// three values in usable numbers. Gross errors should be left out. O(N). Nothing where `control.stop` asked, polled
/// per stretch.
[[nodiscard]] std::optional<LatticeNoise> lattice_noise(std::span<const double> samples, double step,
                                                        std::size_t stretch, const RunControl& control = {});

/// Coarser than this (standard deviation over step) a shape is simulated; coarser than the second it is refused.
inline constexpr double kCoarseLattice = 0.8;
inline constexpr double kTooCoarseLattice = 0.35;

/// The shape of a record on a lattice: empty where it is on none or the lattice is fine. 32 records of at most 16,384
/// samples are simulated. `intervals`, `plan`: of the record's classical curve in the units of the samples times
/// 1/`unit_square`. Same seed, same bits. Empty
/// where `control.stop` asked.
[[nodiscard]] RobustShape lattice_shape(std::span<const double> samples, double unit_square,
                                        const VarianceIntervals& intervals, HaarCovariance& plan, std::uint64_t seed,
                                        const RunControl& control = {});

}  // namespace driftlab
