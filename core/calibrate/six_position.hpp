#pragma once
/// The six-position test: bias and scale factor of a triad from positions (or rates) whose true values are known.
///
/// Accelerometers: each axis once up and once down, true value +-g along it. Gyroscopes: each axis turned at known
/// rates both ways, true value +-rate. Seed paper, equations (9) and (10); Titterton and Weston, Strapdown Inertial
/// Navigation Technology, 2nd ed., section 8.
///
/// Two forms of the law in core/calibrate/triad.hpp:
///   per axis     b_i and S_i alone, from the positions whose true value lies along axis i (at least 90 % of its
///   length). With
///                one up u and one down d: b = (u + d)/2, S = (u - d)/(2 g) - 1. A tilt of the table of t rad costs
///                t^2/2 of the scale factor and nothing of the bias: the positions across the axis, which it would
///                reach to first order, are not used.
///   with axes    all 12 numbers, by weighted least squares over every position and axis: 18 readings for 12 numbers in
///   the
///                plain test. Misalignments are against the axes in which the true values are given: a table that is
///                not level is not told from sensors that are not square.
///
/// Intervals: 95 %, from the uncertainties of the means; where more readings than numbers scatter by more than those
/// say (tilt, temperature), widened by sqrt(chi^2/dof) and Student's t. Per axis with two positions nothing is left to
/// scatter.
#include "core/calibrate/triad.hpp"

#include <optional>
#include <vector>

namespace driftlab {

/// One position: what the triad read, and what an ideal one would have read there [SI].
struct KnownPosition {
  TriadMean reading;
  Triple truth{};
};

struct SixPositionOptions {
  bool misalignment = false;  ///< estimate the off-diagonal numbers too
};

struct TriadCalibration {
  std::array<Estimate, 3> bias;                           ///< [SI]
  std::array<Estimate, 3> scale_factor;                   ///< S, a ratio: 1e-3 is 1000 ppm
  std::array<std::array<Estimate, 3>, 3> misalignment{};  ///< [rad] off the diagonal; zeros where it is not estimated
  TriadLaw law;                                           ///< the same numbers, to correct readings with
  std::size_t readings = 0;                               ///< used, of one axis in one position
  double chi_square_per_dof = 0.0;                        ///< 0 where no degree of freedom is left
  double residual_before = 0.0;  ///< rms of reading minus truth over all positions and axes [SI]
  double residual_after = 0.0;   ///< the same of corrected readings
};

/// An axis of which some uncertainty is 0 (unknown) is weighted evenly, and its interval taken from the scatter;
/// without end where nothing is left to scatter. Errors: TooFewSamples (an axis lacks a position up or down; the 12
/// numbers need 4 positions that are not in a plane), NonFinite. O(positions).
[[nodiscard]] Result<TriadCalibration> calibrate_six_positions(std::span<const KnownPosition> positions,
                                                               const SixPositionOptions& options = {});

}  // namespace driftlab
