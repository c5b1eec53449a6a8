#include "core/variance/power_spectrum.hpp"

#include "core/variance/sine_tapers.hpp"
#include "core/variance/variance_intervals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr std::size_t kFewest = 64;
constexpr double kBinsPerOctave = 12.0;
constexpr double kFalseLine = 0.01;
constexpr std::size_t kAround = 64;
constexpr std::size_t kBeside = 4;
/// One over the relative variance of the median of 128 ordinates, 1/(n ln^2 2), where the correlation of neighbours
/// under the first taper leaves n = 85 of them.
constexpr double kLevelKnown = 41.0;
/// Below this ordinate the density may fall too much across the ordinates around it.
constexpr std::size_t kFirstLine = 4 * (kAround + kBeside);
constexpr std::size_t kMostLines = 32;

std::vector<SpectrumLine> lines_of(const std::vector<double>& power, std::size_t samples, double dt_s) {
  std::vector<SpectrumLine> lines;
  const double limit =
      kLevelKnown * (std::pow(static_cast<double>(power.size()) / kFalseLine, 1.0 / kLevelKnown) - 1.0);
  std::vector<double> around;
  for (std::size_t i = kFirstLine; i + 1 < power.size(); ++i) {
    if (power[i] < power[i - 1] || power[i] <= power[i + 1]) {
      continue;
    }
    around.clear();
    for (std::size_t d = kBeside + 1; d <= kAround + kBeside; ++d) {
      around.push_back(power[i - d]);
      if (i + d < power.size()) {
        around.push_back(power[i + d]);
      }
    }
    const auto middle = around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2);
    std::nth_element(around.begin(), middle, around.end());
    const double excess = power[i] * std::numbers::ln2 / *middle;  // the median of a chi-square of two degrees
    if (excess > limit) {
      // A sinusoid of amplitude a at a Fourier frequency gives a^2 n/4 of the squared sum of the taper, 8 n/pi^2 of n.
      const double signal = power[i] * (1.0 - 1.0 / excess) * std::numbers::pi * std::numbers::pi / 8.0;
      lines.push_back({static_cast<double>(i) / (static_cast<double>(samples + 1) * dt_s),
                       2.0 * std::sqrt(signal / static_cast<double>(samples)), excess});
    }
  }
  std::sort(lines.begin(), lines.end(),
            [](const SpectrumLine& a, const SpectrumLine& b) { return a.excess > b.excess; });
  lines.resize(std::min(lines.size(), kMostLines));
  std::sort(lines.begin(), lines.end(),
            [](const SpectrumLine& a, const SpectrumLine& b) { return a.frequency_hz < b.frequency_hz; });
  return lines;
}

}  // namespace

PowerSpectrum power_spectrum(std::span<const double> samples, double pivot, double dt_s, const RunControl& control) {
  PowerSpectrum result;
  if (samples.size() < kFewest || control.stop.stop_requested()) {
    return result;
  }
  const std::span<const double> used = samples.first(fast_taper_samples(samples.size()));
  const SineTapers transform(used, pivot);
  if (control.stop.stop_requested()) {
    return result;
  }
  const std::size_t ordinates = transform.ordinates();
  std::vector<double> first(ordinates, 0.0);
  const double resolution_hz = 1.0 / (static_cast<double>(used.size() + 1) * dt_s);
  const double growth = std::exp2(1.0 / kBinsPerOctave) - 1.0;
  for (std::size_t i = 1; i < ordinates;) {
    const auto width = std::max<std::size_t>(1, static_cast<std::size_t>(growth * static_cast<double>(i)));
    const std::size_t end = std::min(ordinates, i + width);
    double sum = 0.0;
    for (std::size_t j = i; j < end; ++j) {
      first[j] = transform.eigenspectrum(j, 1);
      sum += first[j];
      for (int k = 2; k <= kSineTapers; ++k) {
        sum += transform.eigenspectrum(j, k);
      }
    }
    const double density = 2.0 * dt_s * sum / (kSineTapers * static_cast<double>(end - i));
    const double edf = sine_taper_edf(end - i);
    result.frequency_hz.push_back(0.5 * static_cast<double>(i + end - 1) * resolution_hz);
    result.density.push_back(density);
    result.edf.push_back(edf);
    result.ci95.push_back(chi_square_interval(density, edf));
    i = end;
  }
  if (control.stop.stop_requested()) {
    return {};
  }
  result.lines = lines_of(first, used.size(), dt_s);
  return result;
}

}  // namespace driftlab
