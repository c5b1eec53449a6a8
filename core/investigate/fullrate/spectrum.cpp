#include "core/investigate/fullrate/spectrum.hpp"

#include "core/investigate/fullrate/fourier.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab::investigate {
namespace {

/// From a bin to the next: 280 bins over three decades. Chosen, not measured.
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

std::vector<std::complex<double>> half_spectrum_of(const Series& values, std::size_t length,
                                                   const std::stop_token& stop) {
  const std::size_t count = values.size();
  const auto at = [&](std::size_t i) { return i < count ? values[i] : 0.0; };
  return half_spectrum(length == 0 ? count : length, at, kWholeTransform, stop);
}

Spectrum estimate_spectrum(const Series& error, double dt_s, double f_low_hz, const std::stop_token& stop) {
  Spectrum result;
  result.dt_s = dt_s;
  result.samples = fast_length(error.size());
  double mean = 0.0;
  for (std::size_t i = 0; i < result.samples; ++i) {
    mean += error[i];
  }
  mean /= static_cast<double>(result.samples);
  const auto n = static_cast<double>(result.samples);
  const auto at = [&](std::size_t i) { return error[i] - mean; };
  const auto values = half_spectrum(result.samples, at, kWholeTransform, stop);
  if (stop.stop_requested()) {
    return result;
  }
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

double slow_density(const SlowModel& model, std::size_t r, double f_hz, double dt_s, double samples) {
  double sum = 0.0;
  for (const SlowComponent& component : model.components) {
    if (component.acts_in(r) && component.kind().expected_periodogram != nullptr) {
      sum += component.kind().expected_periodogram(component.process.square(), component.process.only_shape(), f_hz,
                                                   dt_s, samples);
    }
  }
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
