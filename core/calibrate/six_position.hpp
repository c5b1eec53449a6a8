#pragma once
/// The six-position test: bias and scale factor of a triad from positions (or rates) whose true values are known.
///
/// Accelerometers: each axis points once up and once down, and the true value along it is +-g. Gyroscopes: each axis is
/// turned at known rates in both directions, and the true value is +-rate. Seed paper, equations (9) and (10);
/// Titterton and Weston, Strapdown Inertial Navigation Technology, 2nd ed., section 8.
///
/// The error model is that of core/calibrate/triad.hpp, in one of two forms.
///
/// Per axis: only b_i and S_i are estimated, from the positions in which at least 90 % of the true value's length lies
/// along axis i. With one reading up, u, and one down, d: b = (u + d)/2 and S = (u - d)/(2 g) - 1. A tilt of the table
/// by t rad changes the scale factor by t^2/2 and the bias not at all. Positions across the axis, in which a tilt has a
/// first-order effect, are not used.
///
/// With misalignment: all 12 parameters are estimated by weighted least squares over every position and axis; the plain
/// test gives 18 readings for 12 parameters. Misalignments are relative to the axes in which the true values are given:
/// a table that is not level cannot be told from sensor axes that are not orthogonal.
///
/// Intervals are 95 %, from the uncertainties of the means. If there are more readings than parameters and they scatter
/// by more than those uncertainties allow (tilt, temperature), the intervals are widened by sqrt(chi^2/dof) with
/// Student's t. Per axis with two positions no degree of freedom is left for that.
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
  std::array<Estimate, 3> bias;          ///< [SI]
  std::array<Estimate, 3> scale_factor;  ///< S, a ratio: 1e-3 is 1000 ppm
  AxisAngles misalignment{};             ///< nothing anywhere without `SixPositionOptions::misalignment`
  TriadLaw law;                          ///< the same numbers, to correct readings with
  std::size_t readings = 0;              ///< used, of one axis in one position
  double chi_square_per_dof = 0.0;       ///< 0 where no degree of freedom is left
  double residual_before = 0.0;          ///< rms of reading minus truth over all positions and axes [SI]
  double residual_after = 0.0;           ///< the same of corrected readings
};

/// If some uncertainty of an axis is 0 (unknown), its readings are weighted evenly and its interval comes from their
/// scatter; the interval is infinite if no degree of freedom is left. Errors: TooFewSamples (an axis lacks a position
/// up or down; the 12 parameters need 4 positions that are not in a plane), NonFinite. O(positions).
[[nodiscard]] Result<TriadCalibration> calibrate_six_positions(std::span<const KnownPosition> positions,
                                                               const SixPositionOptions& options = {});

}  // namespace driftlab
