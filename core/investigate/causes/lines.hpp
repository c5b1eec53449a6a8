#pragma once
/// Detection of sinusoids in the innovations.
///
/// Let Z(f) be the Fourier transform of n whitened samples. X = 2 |Z|^2 / (n local mean) is chi-square with two degrees
/// of freedom at every frequency without a line. The local mean is the larger of those of a wide and a narrow
/// neighbourhood, so that a broad maximum of the spectrum is not mistaken for a line. For R recordings with one
/// amplitude and free phases,
///   T = (sum sqrt(n_r X_r))^2 / sum n_r,
///   P(T > s^2) ~ prod(a_r) s^{R-1} (2 pi)^{(R-1)/2} exp(-s^2/2), a_r = sqrt(n_r / sum n),
/// which is the tail of a weighted sum of Rayleigh variables. The score is -2 ln of that probability times the number
/// of independent frequencies. Several other peaks close to a line mean narrow-band noise and not a line.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

namespace driftlab::investigate {

/// The strongest line of each scope (all recordings, the moving ones, each single one) that stands out at all.
/// Parameters: amplitude [SI], frequency [Hz]. One transform per recording.
[[nodiscard]] std::vector<Evidence> find_lines(const FullRate& data);

/// The strongest line of a scope within `within_hz` of a frequency, however weak, as `find_lines` describes it.
[[nodiscard]] Evidence line_near(const FullRate& data, const std::vector<std::size_t>& scope, double f_hz,
                                 double within_hz);

/// The sinusoid of frequency f that fits a recording best by generalised least squares: its values, to be subtracted.
[[nodiscard]] std::vector<double> fitted_line(const FullRate& data, std::size_t r, double f_hz);

/// Log likelihood that a line of known frequency and amplitude, phases unknown, gains in the recordings of a scope:
/// sum over them of ln I0(A m / v) - A^2 / (2 v), m the modulus of the fitted phasor and v its variance per component.
[[nodiscard]] double line_gain(const FullRate& data, const std::vector<std::size_t>& scope, double f_hz,
                               double amplitude);

}  // namespace driftlab::investigate
