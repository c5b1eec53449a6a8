#pragma once
/// Calibration of an accelerometer triad from positions whose attitude nobody knows: at rest the corrected reading must
/// be as long as gravity, whatever the attitude. Tedaldi, Pretto and Menegatti, "A robust and easy to implement method
/// for IMU calibration without external equipments", ICRA 2014, section IV, without its gyroscope part.
///
/// Model: x = A (y - b), A upper triangular with positive diagonal, |x| = g: nine numbers. The rotation of the triad as
/// a whole cannot be seen, so A is triangular: its z axis is that of the sensor z, its y axis lies in the plane of
/// sensors y and z. The readings y may be in any unit with any offset (counts of a converter); A then holds the unit.
///
/// Estimated by least squares of |x_k| - g over the positions k, all weighted alike (Levenberg-Marquardt from the
/// middle and half width of the readings). Intervals: linearised, with the scatter of the residuals and Student's t
/// with n - 9 degrees of freedom. A constant error of g is a common scale of A and is not seen.
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
};

/// Errors: TooFewSamples (below 10 positions, or all in one half of an axis), InvalidArgument (g not positive),
/// NonFinite.
[[nodiscard]] Result<MultiPositionCalibration> calibrate_multi_position(std::span<const Triple> readings,
                                                                        double gravity_m_s2);

}  // namespace driftlab
