#include "core/variance/spectral_lines.hpp"

#include "core/variance/welch.hpp"

#include <algorithm>

namespace driftlab {
namespace {

constexpr std::size_t kFewestSamples = 2048;
constexpr std::size_t kWindows = 32;
constexpr std::size_t kMostWindows = 512;
constexpr std::size_t kLongest = 8192;
constexpr std::size_t kCoarser = 4;
/// Bins next to frequency zero, into which a Hann window leaks.
constexpr std::size_t kFirstBin = 4;
constexpr double kExcess = 2.0;
/// Two maxima closer than this ratio of frequencies are one.
constexpr double kApart = 1.5;
/// Bins from the maximum of a sinusoid at which a Hann window leaves less than a quarter of it.
constexpr std::size_t kLobe = 3;

/// Mean periodogram of Hann windows of `length` samples, bins 0 .. length/2; empty if stopped.
std::vector<double> periodogram(std::span<const double> samples, double pivot, std::size_t length,
                                const RunControl& control) {
  const std::size_t windows = std::min(samples.size() / length, kMostWindows);
  WelchPeriodogram mean(length, Taper::Hann, 1.0);
  for (std::size_t w = 0; w < windows; ++w) {
    if (control.stop.stop_requested()) {
      return {};
    }
    const std::size_t from = windows > 1 ? (samples.size() - length) / (windows - 1) * w : 0;
    mean.add(samples.subspan(from, length), {.level = pivot});
  }
  return mean.mean();
}

/// Power over its median in the octave below and the octave above.
double excess_at(const std::vector<double>& power, std::size_t k) {
  const auto from = power.begin() + static_cast<std::ptrdiff_t>(std::max(kFirstBin, k / 2));
  const auto to = power.begin() + static_cast<std::ptrdiff_t>(std::min(power.size() - 1, 2 * k + 1));
  std::vector<double> around(from, to);
  const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
  std::nth_element(around.begin(), middle, around.end());
  return *middle > 0.0 ? power[k] / *middle : 0.0;
}

}  // namespace

std::vector<SpectralLine> spectral_lines(std::span<const double> samples, double pivot, std::size_t most,
                                         const RunControl& control) {
  std::vector<SpectralLine> found;
  if (samples.size() < kFewestSamples) {
    return found;
  }
  std::size_t length = kFewestSamples / kWindows;
  while (length < kLongest && 2 * length * kWindows <= samples.size()) {
    length *= 2;
  }
  const std::vector<double> fine = periodogram(samples, pivot, length, control);
  const std::vector<double> coarse = periodogram(samples, pivot, length / kCoarser, control);
  if (fine.empty() || coarse.empty()) {
    return found;
  }
  std::vector<SpectralLine> maxima;
  for (std::size_t k = kFirstBin * kCoarser; k + 2 < fine.size(); ++k) {
    if (fine[k] < fine[k - 1] || fine[k] < fine[k + 1]) {
      continue;
    }
    const double excess = excess_at(fine, k);
    const std::size_t same = (k + kCoarser / 2) / kCoarser;
    if (excess < kExcess || same + 1 >= coarse.size() || excess_at(coarse, same) < kExcess) {
      continue;
    }
    const double beside = std::max(fine[k - kLobe], k + kLobe < fine.size() ? fine[k + kLobe] : 0.0);
    maxima.push_back({static_cast<double>(k) / static_cast<double>(length), excess, beside < 0.25 * fine[k]});
  }
  std::sort(maxima.begin(), maxima.end(),
            [](const SpectralLine& a, const SpectralLine& b) { return a.excess > b.excess; });
  for (const SpectralLine& line : maxima) {
    const bool known = std::any_of(found.begin(), found.end(), [&](const SpectralLine& other) {
      return std::max(line.frequency, other.frequency) < kApart * std::min(line.frequency, other.frequency);
    });
    if (!known && found.size() < most) {
      found.push_back(line);
    }
  }
  return found;
}

}  // namespace driftlab
