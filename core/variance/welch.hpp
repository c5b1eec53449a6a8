#pragma once
/// Welch's mean periodogram: the power spectral density of a record as a mean over pieces of it.
///
/// From each piece of L samples at dt a line is subtracted; the residual x_t is multiplied by a window w_t and
/// transformed. The two-sided density at f_k = k/(L dt), k = 0 ... L/2, is the mean over all pieces of
///   dt / (w_1^2 + ... + w_L^2) |sum_t w_t x_t exp(-2 pi i k t/L)|^2   [unit^2/Hz]
/// (Welch 1967, eqs. 3 to 5, with a density that counts negative frequencies too). Of white noise N its mean is N^2 at
/// every frequency; of other noise the mean is the density smoothed by the window's own spectrum, and the noise must be
/// stationary over the pieces for it to mean anything. A sinusoid A cos(2 pi f_m dt t) behind a Hann window gives A^2 L
/// dt/6 at f_m and a quarter of that at either side.
///
/// Hann: w_t = (1 - cos(2 pi (t + 1/2)/L))/2. Its leakage falls as f^-6 in power and is worth 1.5 bins. None: w_t = 1,
/// the periodogram of Bartlett (1950), whose leakage falls only as f^-2 and which is meant for series that are white
/// already. Disjoint pieces of Gaussian noise are independent, so that the mean of K has 2 K degrees of freedom; Hann
/// pieces that overlap by half have 36 K^2/(19 K - 1) (Percival and Walden 1993, eq. 292b).
///
/// The caller chooses the places of the pieces, because it knows which samples must be skipped. The order of the sums
/// is that of the pieces: the same pieces in the same order give the same bits.
#include <unsupported/Eigen/FFT>

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

enum class Taper { Hann, None };

/// The line that is subtracted from a piece: level + slope t, t = 0 at its first.
struct PieceLine {
  double level = 0.0;  ///< [unit of the samples]
  double slope = 0.0;  ///< [unit a sample]
};

class WelchPeriodogram {
 public:
  /// Of pieces of `length` samples, at least 2, `dt_s` apart.
  WelchPeriodogram(std::size_t length, Taper taper, double dt_s);

  /// Adds the periodogram of `piece`, which holds `length` finite samples. O(length log length).
  void add(std::span<const double> piece, PieceLine off);

  [[nodiscard]] std::size_t length() const { return window_.size(); }
  [[nodiscard]] std::size_t pieces() const { return pieces_; }
  /// The density at k/(length dt), k = 0 ... length/2 [unit^2/Hz]; all 0 before the first piece.
  [[nodiscard]] std::vector<double> mean() const;

 private:
  std::vector<double> window_;
  double scale_ = 0.0;  ///< density in one squared ordinate
  std::size_t pieces_ = 0;
  std::vector<double> sum_;
  std::vector<double> windowed_;
  std::vector<std::complex<double>> ordinates_;
  Eigen::FFT<double> fft_;
};

}  // namespace driftlab
