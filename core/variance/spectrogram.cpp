#include "core/variance/spectrogram.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kFewest = 64;
constexpr std::size_t kShortestCell = 32;
constexpr std::size_t kLongestWindow = 4096;
constexpr std::size_t kMostWindows = 16;

/// Density at Fourier frequencies 1 to length/2 - 1 of windows of one length, averaged over a cell.
class CellSpectrum {
 public:
  CellSpectrum(std::size_t length, double pivot, double dt_s)
      : pivot_(pivot), dt_s_(dt_s), hann_(length), windowed_(length), half_(length / 2 + 1) {
    for (std::size_t t = 0; t < length; ++t) {
      hann_[t] =
          0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(t) + 0.5) / static_cast<double>(length));
      energy_ += hann_[t] * hann_[t];
    }
    fft_.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  }

  std::vector<double> of(std::span<const double> cell) {
    const std::size_t length = hann_.size();
    const std::size_t fitting = (cell.size() - length) / (length / 2) + 1;
    const std::size_t windows = std::min(fitting, kMostWindows);
    std::vector<double> power(length / 2, 0.0);
    for (std::size_t w = 0; w < windows; ++w) {
      const std::size_t first = windows == 1 ? 0 : (cell.size() - length) * w / (windows - 1);
      for (std::size_t t = 0; t < length; ++t) {
        windowed_[t] = (cell[first + t] - pivot_) * hann_[t];
      }
      fft_.fwd(half_.data(), windowed_.data(), static_cast<Eigen::Index>(length));
      for (std::size_t i = 1; i < power.size(); ++i) {
        power[i] += std::norm(half_[i]);
      }
    }
    for (double& ordinate : power) {
      ordinate *= dt_s_ / (energy_ * static_cast<double>(windows));
    }
    return power;
  }

 private:
  double pivot_;
  double dt_s_;
  double energy_ = 0.0;
  std::vector<double> hann_;
  std::vector<double> windowed_;
  std::vector<std::complex<double>> half_;
  Eigen::FFT<double> fft_;
};

/// First and last-but-one Fourier frequency of each band; no band is empty.
std::vector<std::pair<std::size_t, std::size_t>> bands_of(std::size_t ordinates, std::size_t bands) {
  std::vector<std::pair<std::size_t, std::size_t>> result;
  const double whole = std::log(static_cast<double>(ordinates));
  for (std::size_t i = 1, band = 1; i < ordinates; ++band) {
    const double end = std::exp(whole * static_cast<double>(band) / static_cast<double>(bands));
    const std::size_t next = std::min(ordinates, std::max(i, static_cast<std::size_t>(std::lround(end))));
    if (next > i) {
      result.emplace_back(i, next);
    }
    i = next;
  }
  return result;
}

}  // namespace

Spectrogram spectrogram(std::span<const double> samples, double pivot, double dt_s, std::size_t cells,
                        std::size_t bands, const RunControl& control) {
  Spectrogram result;
  if (samples.size() < kFewest) {
    return result;
  }
  const std::size_t count = std::max<std::size_t>(1, std::min(cells, samples.size() / kShortestCell));
  const std::size_t cell = samples.size() / count;
  const std::size_t length = std::min(kLongestWindow, std::bit_floor(cell));
  const auto edges = bands_of(length / 2, bands);
  CellSpectrum spectrum(length, pivot, dt_s);
  for (const auto& [first, end] : edges) {
    result.frequency_hz.push_back(0.5 * static_cast<double>(first + end - 1) / (static_cast<double>(length) * dt_s));
  }
  for (std::size_t c = 0; c < count; ++c) {
    if (control.stop.stop_requested()) {
      return {};
    }
    const std::vector<double> power = spectrum.of(samples.subspan(c * cell, cell));
    result.time_s.push_back((static_cast<double>(c) + 0.5) * static_cast<double>(cell) * dt_s);
    for (const auto& [first, end] : edges) {
      double sum = 0.0;
      for (std::size_t i = first; i < end; ++i) {
        sum += power[i];
      }
      result.density.push_back(sum / static_cast<double>(end - first));
    }
  }
  result.window_samples = length;
  return result;
}

}  // namespace driftlab
