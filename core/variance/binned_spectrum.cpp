#include "core/variance/binned_spectrum.hpp"

#include "core/variance/sine_tapers.hpp"
#include "core/variance/variance_intervals.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

constexpr std::size_t kFewest = 64;
constexpr std::size_t kLongestSegment = std::size_t{1} << 20U;
constexpr std::size_t kMostSegments = 32;

/// The bin of Fourier frequency i of `ordinates`.
std::size_t bin_of(std::size_t i, std::size_t ordinates, FrequencyScale scale, std::size_t bins) {
  const double share = scale == FrequencyScale::Log
                           ? std::log(static_cast<double>(i)) / std::log(static_cast<double>(ordinates))
                           : static_cast<double>(i) / static_cast<double>(ordinates);
  return std::min(bins - 1, static_cast<std::size_t>(share * static_cast<double>(bins)));
}

/// Mean eigenspectrum at every Fourier frequency, over all segments.
std::vector<double> mean_spectrum(std::span<const double> samples, double pivot, std::size_t length,
                                  std::size_t segments, const RunControl& control) {
  std::vector<double> power;
  for (std::size_t s = 0; s < segments; ++s) {
    if (control.stop.stop_requested()) {
      return {};
    }
    const std::size_t first = segments == 1 ? 0 : (samples.size() - length) / (segments - 1) * s;
    const SineTapers tapers(samples.subspan(first, length), pivot);
    power.resize(tapers.ordinates(), 0.0);
    for (std::size_t i = 1; i < power.size(); ++i) {
      for (int k = 1; k <= kSineTapers; ++k) {
        power[i] += tapers.eigenspectrum(i, k);
      }
    }
  }
  for (double& ordinate : power) {
    ordinate /= static_cast<double>(segments) * kSineTapers;
  }
  return power;
}

}  // namespace

BinnedSpectrum binned_spectrum(std::span<const double> samples, double pivot, double dt_s, FrequencyScale scale,
                               std::size_t bins, const RunControl& control) {
  BinnedSpectrum result;
  if (samples.size() < kFewest || bins == 0) {
    return result;
  }
  const std::size_t length = fast_taper_samples(std::min(samples.size(), kLongestSegment));
  const std::size_t segments = samples.size() <= kLongestSegment ? 1 : std::min(kMostSegments, samples.size() / length);
  const std::vector<double> power = mean_spectrum(samples, pivot, length, segments, control);
  if (power.empty()) {
    return result;
  }
  result.segments = segments;
  result.segment_samples = length;
  const double resolution_hz = 1.0 / (static_cast<double>(length + 1) * dt_s);
  for (std::size_t i = 1; i < power.size();) {
    const std::size_t bin = bin_of(i, power.size(), scale, bins);
    std::size_t end = i;
    double sum = 0.0;
    double greatest = 0.0;
    while (end < power.size() && bin_of(end, power.size(), scale, bins) == bin) {
      sum += power[end];
      greatest = std::max(greatest, power[end]);
      ++end;
    }
    const auto count = static_cast<double>(end - i);
    const double density = dt_s * sum / count;
    result.frequency_hz.push_back(0.5 * static_cast<double>(i + end - 1) * resolution_hz);
    result.density.push_back(density);
    result.ci95.push_back(chi_square_interval(density, sine_taper_edf(end - i) * static_cast<double>(segments)));
    result.greatest.push_back(dt_s * greatest);
    i = end;
  }
  return result;
}

}  // namespace driftlab
