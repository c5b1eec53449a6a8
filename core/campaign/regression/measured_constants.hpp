#pragma once
/// Constants of regression runs that no theory gives: what a session (a power-up of the device) adds to the logarithm
/// of a deviation, before the sessions of a run are asked (session_scatter.hpp).
///
/// They were set with six recordings of 2.8 h of the ADIS16405 in view (spec/regression.md, section 5: between sessions
/// 3 to 4 % for the gyroscope, 2 to 5.4 % for the accelerometer). Three of the six can be had by everybody; of them
///     python3 tests/accuracy/session_scatter.py SHARED
/// prints, at tau of 0.01 to 0.64 s:
///     gyroscope: device 0.65 %, axis 0.20 %, scale 0.92 %; together 1.14 % of a deviation
///     accelerometer: device 2.25 %, axis 3.51 %, scale 1.40 %; together 4.40 % of a deviation
///     correlation of the scale's part with its neighbour's +0.43 and +0.35
/// Rigs differ by factors: the values are the middle of a prior that the factors kL and kS widen and narrow.

namespace driftlab::regression {

/// Prior standard deviations of what a session adds [ln deviation].
struct Tau0 {
  double device = 0.0;  ///< common to all axes and scales
  double axis = 0.0;    ///< common to the scales of one axis
  double scale = 0.0;   ///< of one scale, correlated exp(-|j - j'|/kOctavesOfCorrelation) with its neighbours
};

inline constexpr Tau0 kGyroscopeTau0{0.010, 0.012, 0.012};
inline constexpr Tau0 kAccelerometerTau0{0.015, 0.025, 0.025};

/// exp(-1/1.5) = 0.51 between neighbouring octaves, 0.26 over two.
inline constexpr double kOctavesOfCorrelation = 1.5;

}  // namespace driftlab::regression
