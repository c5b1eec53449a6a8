#pragma once
/// Second differences of a lag function, which give the covariance of the Haar wavelet coefficients of a process
/// (Percival 1995).
#include <cmath>
#include <numbers>

namespace driftlab {

/// -D_mi D_mj K(h) / (4 mi mj), with D_m f(h) = f(h + m) - 2 f(h) + f(h - m). This is the covariance of the Haar
/// wavelet coefficients of half lengths mi and mj whose filter centres are h samples apart. K is the lag function of
/// the process: the second difference of K is the autocovariance gamma, or, for a process that has stationary
/// increments only, K is minus half the variogram summed twice.
template <class LagFunction>
[[nodiscard]] double haar_cross_of(double mi, double mj, double h, const LagFunction& k) {
  if (mi == mj) {
    const double sum = (k(h + 2 * mi) + k(h - 2 * mi)) - 4 * (k(h + mi) + k(h - mi)) + 6 * k(h);
    return -sum / (4 * mi * mj);
  }
  const double outer = k(h + mi + mj) + k(h + mi - mj) + k(h - mi + mj) + k(h - mi - mj);
  const double middle = k(h + mi) + k(h - mi) + k(h + mj) + k(h - mj);
  return -(outer - 2 * middle + 4 * k(h)) / (4 * mi * mj);
}

/// sin(pi f m) for frequencies in cycles per sample and whole m up to 2^40, without losing the phase of large m.
struct ScaledPhase {
  double sine;
  double cosine;
};
[[nodiscard]] inline ScaledPhase scaled_phase(double frequency, double m) {
  const double high = frequency * m;
  const double low = std::fma(frequency, m, -high);
  const double turn = (high - 2.0 * std::nearbyint(0.5 * high)) + low;  // the remainder by 2, exact as well
  return {std::sin(std::numbers::pi * turn), std::cos(std::numbers::pi * turn)};
}

}  // namespace driftlab
