#pragma once
/// The eigenspectra of a record under sine tapers, from one transform.
///
/// With v_k(t) = sqrt(2/(n + 1)) sin(pi k t/(n + 1)), k = 1 .. 5 (Riedel and Sidorenko 1995), and X the transform of
/// the record padded to 2 (n + 1) points, S_k(f_i) ~ |X(2i - k) - X(2i + k)|^2 at the Fourier frequencies f_i = i/((n +
/// 1) dt). Their leakage falls as f^-4.
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

inline constexpr int kSineTapers = 5;

/// The largest n up to `limit` for which 2 (n + 1) has no factor but 2, 3 and 5; `limit` where there is none above 64.
[[nodiscard]] std::size_t fast_taper_samples(std::size_t limit);

class SineTapers {
 public:
  /// `samples` are finite; `pivot` is near their mean. O(N log N) time, 48 bytes a sample.
  SineTapers(std::span<const double> samples, double pivot);

  /// Eigenspectrum of taper k, 1 to 5, at Fourier frequency i, over dt: of white noise the variance, on average.
  [[nodiscard]] double eigenspectrum(std::size_t i, int k) const;
  /// Fourier frequencies between 0 and the Nyquist frequency, without either, and one.
  [[nodiscard]] std::size_t ordinates() const;

 private:
  [[nodiscard]] std::complex<double> at(long j) const;

  long length_;
  std::vector<std::complex<double>> half_;
};

/// Degrees of freedom of the mean of all five eigenspectra over `count` neighbouring Fourier frequencies, where the
/// density is even across them.
[[nodiscard]] double sine_taper_edf(std::size_t count);

}  // namespace driftlab
