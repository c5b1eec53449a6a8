#include "core/variance/spectrogram.hpp"

#include "core/variance/welch.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kFewest = 64;
constexpr std::size_t kShortestCell = 32;
constexpr std::size_t kLongestWindow = 4096;
constexpr std::size_t kMostWindows = 16;

/// Density at the Fourier frequencies of windows of one length, averaged over a cell.
std::vector<double> density_of(std::span<const double> cell, double pivot, double dt_s, std::size_t length) {
  const std::size_t fitting = (cell.size() - length) / std::max<std::size_t>(1, length / 2) + 1;
  const std::size_t windows = std::min(fitting, kMostWindows);
  WelchPeriodogram mean(length, Taper::Hann, dt_s);
  for (std::size_t w = 0; w < windows; ++w) {
    const std::size_t first = windows == 1 ? 0 : (cell.size() - length) * w / (windows - 1);
    mean.add(cell.subspan(first, length), {.level = pivot});
  }
  return mean.mean();
}

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
  for (const auto& [first, end] : edges) {
    result.frequency_hz.push_back(0.5 * static_cast<double>(first + end - 1) / (static_cast<double>(length) * dt_s));
  }
  for (std::size_t c = 0; c < count; ++c) {
    if (control.stop.stop_requested()) {
      return {};
    }
    const std::vector<double> power = density_of(samples.subspan(c * cell, cell), pivot, dt_s, length);
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
