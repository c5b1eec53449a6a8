#include "core/investigate/fullrate/spectrum.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab::investigate {
namespace {

constexpr double kBinRatio = 1.025;

}  // namespace

std::size_t fast_length(std::size_t n) {
  for (std::size_t length = n; length > 1; --length) {
    std::size_t rest = length;
    for (const std::size_t factor : {2U, 3U, 5U}) {
      while (rest % factor == 0) {
        rest /= factor;
      }
    }
    if (rest == 1 && length % 2 == 0) {
      return length;
    }
  }
  return n;
}

std::vector<std::complex<double>> transform(std::span<const double> values, std::size_t length) {
  length = length == 0 ? values.size() : length;
  std::vector<double> padded(length, 0.0);
  std::copy_n(values.begin(), std::min(length, values.size()), padded.begin());
  std::vector<std::complex<double>> spectrum(length / 2 + 1);
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  fft.fwd(spectrum.data(), padded.data(), static_cast<Eigen::Index>(length));
  return spectrum;
}

Spectrum estimate_spectrum(std::span<const double> error, double dt_s, double f_low_hz) {
  Spectrum result;
  result.dt_s = dt_s;
  result.samples = fast_length(error.size());
  std::vector<double> centred(error.begin(), error.begin() + static_cast<std::ptrdiff_t>(result.samples));
  double mean = 0.0;
  for (const double e : centred) {
    mean += e;
  }
  mean /= static_cast<double>(centred.size());
  for (double& e : centred) {
    e -= mean;
  }
  const auto n = static_cast<double>(result.samples);
  const auto values = transform(centred, 0);
  const double df = 1.0 / (n * dt_s);
  auto k = static_cast<std::size_t>(std::max(1.0, std::ceil(f_low_hz / df)));
  while (k < result.samples / 2) {
    const auto end =
        std::clamp(static_cast<std::size_t>(static_cast<double>(k) * kBinRatio), k + 1, result.samples / 2);
    double sum = 0.0;
    for (std::size_t i = k; i < end; ++i) {
      sum += std::norm(values[i]);
    }
    const auto m = static_cast<double>(end - k);
    result.power.push_back(sum * dt_s / n / m);
    result.weight.push_back(m);
    result.f_hz.push_back(0.5 * static_cast<double>(k + end - 1) * df);
    k = end;
  }
  return result;
}

double slow_density(const SlowModel& model, const BlockSeries& series, std::size_t r, double f_hz, double dt_s,
                    double samples) {
  double sum = 0.0;
  for (const SlowComponent& component : model.components) {
    if (component.acts_in(r) && component.kind->expected_periodogram != nullptr) {
      sum += component.kind->expected_periodogram(component.level, component.beta, f_hz, dt_s, samples);
    }
  }
  (void)series;
  return sum;
}

double butterworth_gain(double f_hz, double corner_hz, double dt_s) {
  const double ratio = std::tan(std::numbers::pi * f_hz * dt_s) / std::tan(std::numbers::pi * corner_hz * dt_s);
  const double square = ratio * ratio;
  return 1.0 / (1.0 + square * square);
}

double quantization_shape(double f_hz, double dt_s) {
  const double s = 2.0 * std::sin(std::numbers::pi * f_hz * dt_s);
  return s * s / dt_s;
}

}  // namespace driftlab::investigate
