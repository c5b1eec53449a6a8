#include "core/variance/power_spectrum.hpp"

#include "core/variance/variance_intervals.hpp"

#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

namespace driftlab {
namespace {

constexpr std::size_t kFewest = 64;
constexpr int kTapers = 5;
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
/// Lags beyond which eigenspectra are taken for independent.
constexpr int kLags = 32;

/// The largest n up to `limit` for which 2 (n + 1) has no factor but 2, 3 and 5.
std::size_t fast_samples(std::size_t limit) {
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

/// X at index j of the transform over 2 (n + 1) points of a real series, any sign of j.
class Transform {
 public:
  Transform(std::span<const double> samples, double pivot) : length_(static_cast<long>(2 * (samples.size() + 1))) {
    std::vector<double> padded(static_cast<std::size_t>(length_), 0.0);
    for (std::size_t t = 0; t < samples.size(); ++t) {
      padded[t + 1] = samples[t] - pivot;
    }
    half_.resize(padded.size() / 2 + 1);
    Eigen::FFT<double> fft;
    fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    fft.fwd(half_.data(), padded.data(), static_cast<Eigen::Index>(padded.size()));
  }

  [[nodiscard]] std::complex<double> at(long j) const {
    const long index = (j % length_ + length_) % length_;
    return 2 * index <= length_ ? half_[static_cast<std::size_t>(index)]
                                : std::conj(half_[static_cast<std::size_t>(length_ - index)]);
  }

  /// Eigenspectrum of taper k at Fourier frequency i, over the variance of white noise.
  [[nodiscard]] double eigenspectrum(std::size_t i, int k) const {
    const long j = 2 * static_cast<long>(i);
    return std::norm(at(j - k) - at(j + k)) / static_cast<double>(length_);
  }

 private:
  long length_;
  std::vector<std::complex<double>> half_;
};

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
  for (int k = 1; k <= kTapers; ++k) {
    for (int l = 1; l <= kTapers; ++l) {
      const int d = 2 * lag;
      sum += std::norm(kernel(d + k - l) - kernel(d + k + l) - kernel(d - k - l) + kernel(d - k + l)) / 4.0;
    }
  }
  return sum / (kTapers * kTapers);
}

/// Degrees of freedom of the mean over `count` neighbouring Fourier frequencies.
double degrees(std::size_t count) {
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
  const std::span<const double> used = samples.first(fast_samples(samples.size()));
  const Transform transform(used, pivot);
  if (control.stop.stop_requested()) {
    return result;
  }
  const std::size_t ordinates = (used.size() + 1) / 2;  // without the Nyquist frequency
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
      for (int k = 2; k <= kTapers; ++k) {
        sum += transform.eigenspectrum(j, k);
      }
    }
    const double density = 2.0 * dt_s * sum / (kTapers * static_cast<double>(end - i));
    const double edf = degrees(end - i);
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
