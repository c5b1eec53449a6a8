#pragma once
/// Constants of the search that no theory gives: each was read off recordings of real sensors.
///
/// They stand here with the measurement behind them. The command that measures each again, on the recordings of
/// tests/hidden/REAL.md, and prints it beside the value that is kept:
///     python3 tests/hidden/real/studies.py SHARED studies
///     python3 tests/hidden/real/constants.py studies
/// The figures below are of that command. Another value changes what is found; the hidden suite and REAL.md say how.

namespace driftlab::investigate {

/// Relative standard deviation with which an unchanged sensor repeats its noise level from recording to recording,
/// beyond the 1/sqrt(2 n) of sampling. Where no model describes the spectra (FullRate::flat), gains of contrasts
/// between recordings of n samples are divided by 1 + 2 n of its square. ADIS16405, three units, nine axes, four pieces
/// of 600 s within 2.5 h: 0.56 % (root mean square; median 0.32 %, at most 1.32 %). With the first piece, in which the
/// unit warms up, 0.93 %.
inline constexpr double kLevelRepeats = 0.006;

/// Means over a second of a channel and of its reference that correlate by less are not of one motion.
/// Of 14 axes those that follow give 0.970 and more (robot arm, MPU-9150; turntable and optical references 0.999 and
/// more), those of another clock or mounting (robot arm, MPU-6500) 0.73, 0.42 and -0.45.
inline constexpr double kLeastCorrelation = 0.85;

/// A mean effect that takes a larger part of the reference rate is no error of a gyroscope but of its reference.
/// Where a reference is followed the largest part is 0.175 (robot arm, MPU-9150, whose reference is differenced over
/// 0.2 s), on turntables and beside optical references 0.011; the turntable's loose stamps once gave +0.55.
inline constexpr double kLargestPart = 0.3;

/// Time stamps whose scatter about the even grid exceeds this many samples place a reference at the wrong time.
/// Turntable with an encoder: 0.5 in the medium run, whose rates follow the encoder within 1 %, and 8.4 in the slow
/// run.
inline constexpr double kLooseStamps = 1.5;

/// If more than this share of the density remains in the stop band, the found low-pass is rejected: it only
/// approximates a spectrum of another shape. ADIS16405, nine axes: 0.46 to 0.51 of the density of 2 to 10 Hz is left at
/// 45 to 50 Hz, where the low-pass of 26 Hz that was once named there leaves less than 0.001.
inline constexpr double kFilled = 0.2;

/// Bursts that fill this share of a recording's seconds or more are not named: the band of a recorded sensor is
/// unsteady by itself. ADIS16405, three units, four pieces of 600 s: the band at 17 to 25 Hz of the three z axes is 1.7
/// to 2.8 times as loud in 24, 35 and 43 % of the seconds. Of the six other axes, one has a band that is 1.2 times as
/// loud in 17 %, the others none in more than 6 %. Below 24 % the limit is a choice: bursts put into recordings take 11
/// to 13 % as they are found.
inline constexpr double kMostOften = 0.2;

}  // namespace driftlab::investigate
