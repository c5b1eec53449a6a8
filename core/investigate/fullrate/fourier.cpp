#include "core/investigate/fullrate/fourier.hpp"

#include "core/signal/progress.hpp"

#include <unsupported/Eigen/FFT>

#include <cmath>
#include <numbers>

namespace driftlab::investigate {
namespace {

using Complex = std::complex<double>;
using Values = std::function<double(std::size_t)>;

/// exp(-2 pi i k / n) for k < n, from an angle below pi/4 as Eigen has it.
Complex factor_of(std::size_t k, std::size_t n) {
  if (2 * k > n) {
    return std::conj(factor_of(n - k, n));
  }
  if (k == 0) {
    return {1.0, 0.0};
  }
  if (2 * k == n) {
    return {-1.0, 0.0};
  }
  const double unit = 0.25 * std::numbers::pi / static_cast<double>(n);
  const auto angle = [&](std::size_t eighths) { return static_cast<double>(eighths) * unit; };
  if (8 * k < n) {
    return {std::cos(angle(8 * k)), -std::sin(angle(8 * k))};
  }
  if (4 * k < n) {
    return {std::sin(angle(2 * n - 8 * k)), -std::cos(angle(2 * n - 8 * k))};
  }
  if (8 * k < 3 * n) {
    return {-std::sin(angle(8 * k - 2 * n)), -std::cos(angle(8 * k - 2 * n))};
  }
  return {-std::cos(angle(4 * n - 8 * k)), -std::sin(angle(4 * n - 8 * k))};
}

/// Joins four transforms of length m, which stand one behind the other, into one.
void join_four(Complex* out, std::size_t m, const std::stop_token& stop) {
  const std::size_t n = 4 * m;
  for (std::size_t k = 0; k < m && !polled(stop, k); ++k) {
    const Complex first = out[k + m] * factor_of(k, n);
    const Complex second = out[k + 2 * m] * factor_of(2 * k, n);
    const Complex third = out[k + 3 * m] * factor_of(3 * k, n);
    const Complex apart = out[k] - second;
    out[k] += second;
    const Complex sum = first + third;
    const Complex difference = first - third;
    const Complex turned(difference.imag(), -difference.real());
    out[k + 2 * m] = out[k] - sum;
    out[k] += sum;
    out[k + m] = apart + turned;
    out[k + 3 * m] = apart - turned;
  }
}

/// Transform of the n complex values at first, first + stride, ..., of which each is two real ones.
void transform_of_pairs(Complex* out, std::size_t n, const Values& at, std::size_t first, std::size_t stride,
                        std::size_t whole, const std::stop_token& stop) {
  if (stop.stop_requested()) {
    return;
  }
  if (n > whole && n % 4 == 0) {
    for (std::size_t q = 0; q < 4; ++q) {
      transform_of_pairs(out + q * (n / 4), n / 4, at, first + q * stride, 4 * stride, whole, stop);
    }
    join_four(out, n / 4, stop);
    return;
  }
  std::vector<Complex> pairs(n);
  for (std::size_t j = 0; j < n; ++j) {
    const std::size_t place = first + j * stride;
    pairs[j] = {at(2 * place), at(2 * place + 1)};
  }
  Eigen::FFT<double>().fwd(out, pairs.data(), static_cast<Eigen::Index>(n));
}

}  // namespace

std::vector<Complex> half_spectrum(std::size_t length, const Values& at, std::size_t whole,
                                   const std::stop_token& stop) {
  std::vector<Complex> spectrum(length / 2 + 1);
  if (length == 0) {
    return spectrum;
  }
  if (length % 4 != 0) {
    std::vector<double> values(length);
    for (std::size_t i = 0; i < length; ++i) {
      values[i] = at(i);
    }
    Eigen::FFT<double> fft;
    fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    fft.fwd(spectrum.data(), values.data(), static_cast<Eigen::Index>(length));
    return spectrum;
  }
  // Even and odd values are the parts of complex ones; their transform is parted again at the end.
  const std::size_t pairs = length / 2;
  transform_of_pairs(spectrum.data(), pairs, at, 0, 1, whole, stop);
  const Complex constant(spectrum[0].real() + spectrum[0].imag());
  const Complex nyquist(spectrum[0].real() - spectrum[0].imag());
  const double pi = std::acos(-1.0);
  for (std::size_t k = 1; k <= pairs / 2 && !polled(stop, k); ++k) {
    const Complex here = spectrum[k];
    const Complex there = std::conj(spectrum[pairs - k]);
    const Complex even = here + there;
    const Complex factor = std::exp(Complex(0.0, -pi * (static_cast<double>(k) / static_cast<double>(pairs) + 0.5)));
    const Complex odd = (here - there) * factor;
    spectrum[k] = (even + odd) * 0.5;
    spectrum[pairs - k] = std::conj(even - odd) * 0.5;
  }
  spectrum[0] = constant;
  spectrum[pairs] = nyquist;
  return spectrum;
}

}  // namespace driftlab::investigate
