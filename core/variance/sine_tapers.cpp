#include "core/variance/sine_tapers.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <array>
#include <numbers>

namespace driftlab {
namespace {

constexpr std::size_t kFewest = 64;
/// Lags beyond which eigenspectra are taken for independent.
constexpr int kLags = 32;

/// Squared correlation of all eigenspectra of one Fourier frequency with all of another `lag` further, over the square
/// of their number. The transform of white noise is correlated at odd distances d only, as 2i/(pi d).
double shared(int lag) {
  const auto kernel = [](int d) {
    if (d == 0) {
      return std::complex<double>(1.0, 0.0);
    }
    return d % 2 == 0 ? std::complex<double>(0.0, 0.0) : std::complex<double>(0.0, 2.0 / (std::numbers::pi * d));
  };
  double sum = 0.0;
  for (int k = 1; k <= kSineTapers; ++k) {
    for (int l = 1; l <= kSineTapers; ++l) {
      const int d = 2 * lag;
      sum += std::norm(kernel(d + k - l) - kernel(d + k + l) - kernel(d - k - l) + kernel(d - k + l)) / 4.0;
    }
  }
  return sum / (kSineTapers * kSineTapers);
}

}  // namespace

std::size_t fast_taper_samples(std::size_t limit) {
  for (std::size_t n = limit; n > kFewest; --n) {
    std::size_t rest = 2 * (n + 1);
    for (const std::size_t factor : {2U, 3U, 5U}) {
      while (rest % factor == 0) {
        rest /= factor;
      }
    }
    if (rest == 1) {
      return n;
    }
  }
  return limit;
}

SineTapers::SineTapers(std::span<const double> samples, double pivot)
    : length_(static_cast<long>(2 * (samples.size() + 1))) {
  std::vector<double> padded(static_cast<std::size_t>(length_), 0.0);
  for (std::size_t t = 0; t < samples.size(); ++t) {
    padded[t + 1] = samples[t] - pivot;
  }
  half_.resize(padded.size() / 2 + 1);
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  fft.fwd(half_.data(), padded.data(), static_cast<Eigen::Index>(padded.size()));
}

std::complex<double> SineTapers::at(long j) const {
  const long index = (j % length_ + length_) % length_;
  return 2 * index <= length_ ? half_[static_cast<std::size_t>(index)]
                              : std::conj(half_[static_cast<std::size_t>(length_ - index)]);
}

double SineTapers::eigenspectrum(std::size_t i, int k) const {
  const long j = 2 * static_cast<long>(i);
  return std::norm(at(j - k) - at(j + k)) / static_cast<double>(length_);
}

std::size_t SineTapers::ordinates() const { return static_cast<std::size_t>(length_) / 4; }

double sine_taper_edf(std::size_t count) {
  static const auto table = [] {
    std::array<double, kLags> values{};
    for (int lag = 0; lag < kLags; ++lag) {
      values[static_cast<std::size_t>(lag)] = shared(lag);
    }
    return values;
  }();
  const auto n = static_cast<double>(count);
  double variance = n * table[0];
  for (std::size_t lag = 1; lag < std::min<std::size_t>(count, kLags); ++lag) {
    variance += 2.0 * (n - static_cast<double>(lag)) * table[lag];
  }
  return 2.0 * n * n / variance;
}

}  // namespace driftlab
