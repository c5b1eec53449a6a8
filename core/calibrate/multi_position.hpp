#pragma once
/// Calibration of an accelerometer triad from rest positions of unknown attitude: at rest the corrected reading must
/// have the magnitude of gravity, whatever the attitude. Tedaldi, Pretto and Menegatti, "A robust and easy to implement
/// method for IMU calibration without external equipments", ICRA 2014, section IV, without its gyroscope part.
///
/// Model: x = A (y - b) with A upper triangular and its diagonal positive, and |x| = g: nine unknowns. A rotation of
/// the triad as a whole cannot be observed, which is why A is triangular: its z axis is that of the z sensor, and its y
/// axis lies in the plane of the y and z sensors. The readings y may be in any unit with any offset (counts of a
/// converter); A then contains the unit.
///
/// The estimate minimises the sum of squares of |x_k| - g over the positions k with equal weights (Levenberg-Marquardt,
/// started from the middle and half width of the readings). Intervals are linearised, with the scatter of the residuals
/// and Student's t with n - 9 degrees of freedom; a number that the positions do not determine at all has an open
/// interval. A constant error of g acts as a common scale of A and cannot be detected.
#include "core/calibrate/triad.hpp"

#include <string>
#include <vector>

namespace driftlab {

struct MultiPositionCalibration {
  std::array<Estimate, 3> bias;  ///< b [unit of the readings]
  std::array<std::array<Estimate, 3>, 3>
      correction{};  ///< A [m/s^2 in one unit of the readings]; zeros below the diagonal
  std::size_t positions = 0;
  double residual_before = 0.0;  ///< rms of |k y| - g [m/s^2] with the one factor k that fits best
  double residual_after = 0.0;   ///< rms of |A (y - b)| - g [m/s^2]
  int iterations = 0;
  bool converged = false;
  double condition = 0.0;  ///< of the scaled normal matrix; above 10^8 the positions do not tell the nine numbers apart
  std::vector<std::string> warnings;

  [[nodiscard]] Triple correct(const Triple& reading) const;
  /// j > i; nothing elsewhere, for the frame is that of the sensors themselves. A_ii (A^-1)_ij, with the interval of
  /// A_ij: that of the diagonal is of second order.
  [[nodiscard]] AxisAngles misalignment() const;
};

/// Errors: TooFewSamples (below 10 positions, or all in one half of an axis), InvalidArgument (g not positive),
/// NonFinite.
[[nodiscard]] Result<MultiPositionCalibration> calibrate_multi_position(std::span<const Triple> readings,
                                                                        double gravity_m_s2);

}  // namespace driftlab
