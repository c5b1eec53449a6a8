#pragma once
/// Constants of regression runs that no theory gives: what a session (a power-up of the device) adds to the logarithm
/// of a deviation, before the sessions of a run are asked (session_scatter.hpp).
///
/// They are chosen, not measured. Each is the middle of a prior, and the factors kL and kS that a run learns (0.60 to
/// 2.87 in 95 % of the prior) widen and narrow it. In view were six recordings of 2.8 h of the ADIS16405
/// (spec/regression.md, section 5). Between them a gyroscope's deviation moved by 3.1 to 3.4 %, of which 1.05 to 1.45 %
/// remain where differing clocks are allowed for; the three parts kept for it make 1.97 % together. An accelerometer's
/// moved by 2 to 5.4 %; its three parts make 3.84 %. The shares of device, axis and scale in that sum are a choice too.
///
/// Three of the six recordings can be had by everybody. They give no constant, but say how far each is from one rig:
///     python3 tests/accuracy/session_scatter.py SHARED
/// prints for tau of 0.01 to 0.64 s, in per cent of a deviation, each beside the value kept here:
///     gyroscope: device 0.65 (1.00), axis 0.20 (1.20), scale 0.92 (1.20), together 1.14 (1.97): kL 0.43, kS 0.77
///     accelerometer: device 2.25 (1.50), axis 3.51 (2.50), scale 1.40 (2.50), together 4.40 (3.84): kL 1.43, kS 0.56
///     correlation of the scale's part with its neighbour's: +0.43 and +0.35 (0.51)
/// The gyroscopes' axes moved together in these three sessions: the part kept for an axis is six times theirs.

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
