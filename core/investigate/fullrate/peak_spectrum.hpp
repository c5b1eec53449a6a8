#pragma once
/// One peak in the spectra of some recordings: the shape of its density, the likelihood of the spectra with it, and the
/// place where it stands.
///
/// The peak is that of a second-order Gauss-Markov process (core/process/resonance.hpp). The density that is expected
/// of the spectra is a sum of four terms:
/// - what is known of each recording: its slow noise, the noise of rounding, and the white noise where a baseline is
///   given;
/// - a white level, the same in all recordings, which is fitted where no baseline is given;
/// - a floor, which is fitted where the white noise is limited in band, for something remains beyond the limit;
/// - the peak.
///
/// The levels that are fitted are those of maximum Whittle likelihood (whittle.hpp).
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/fullrate/whittle.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <vector>

namespace driftlab::investigate {

struct Peak {
  double f_hz = 0.0;  ///< natural frequency
  double quality = 1.0;
};

/// Peaks narrower than half a bin of the spectrum look alike.
inline constexpr double kMostQuality = 60.0;

/// The density of a peak of unit variance. Samples of the process are an ARMA(2,1) process (Maybeck 1979,
/// section 4.11): D(f) = [m0 + 2 m1 cos w] / |1 - p1 e^-iw - p2 e^-2iw|^2, w = 2 pi f dt, m0 and m1 from its
/// autocovariance.
class PeakDensity {
 public:
  PeakDensity(const Peak& peak, double dt_s);
  [[nodiscard]] double at(double f_hz) const;
  /// Averaged over a bin of the spectrum (2.5 % wide) where it holds several ordinates.
  [[nodiscard]] double in_bin(double f_hz, double weight) const;

 private:
  double dt_s_;
  double p1_ = 0.0;
  double p2_ = 0.0;
  double m0_ = 0.0;
  double m1_ = 0.0;
};

/// The spectra of some recordings between two frequencies, one below the other.
class StackedSpectra {
 public:
  StackedSpectra(const FullRate& data, const std::vector<std::size_t>& scope, double low_hz, double high_hz);

  /// The bins of one recording.
  struct Part {
    std::size_t samples = 0;
    std::size_t first = 0;
    std::size_t count = 0;
  };
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
  [[nodiscard]] std::size_t bins() const { return f_hz_.size(); }
  [[nodiscard]] double f_hz(std::size_t j) const { return f_hz_[j]; }
  [[nodiscard]] double power(std::size_t j) const { return power_[j]; }
  [[nodiscard]] double weight(std::size_t j) const { return weight_[j]; }
  [[nodiscard]] double white(std::size_t j) const { return free_white_ ? white_[j] : 0.0; }

  /// Best levels with a peak, whose level comes last, or without one (null).
  [[nodiscard]] LevelFit fit(const Peak* peak) const;
  /// Log likelihood with a peak of that variance; every other level is the best.
  [[nodiscard]] double with(const Peak& peak, double variance) const;
  /// Expected density at levels fitted without a peak.
  [[nodiscard]] std::vector<double> without_peak() const;
  /// Log likelihood where that expectation is free by a factor and by a power of the frequency, with a peak or without.
  [[nodiscard]] double tilted(const std::vector<double>& expected, const Peak* peak, double middle_hz) const;
  /// What one free bin alone would gain: that of a line.
  [[nodiscard]] double gain_of_one_bin(const std::vector<double>& expected) const;

 private:
  /// Everything but the shapes of a peak: columns white, floor, others zero.
  [[nodiscard]] LinearDensity linear(int columns) const;
  /// The peak's density in every bin; recordings of one length have the same bins.
  [[nodiscard]] Eigen::VectorXd column(const Peak& peak) const;

  double dt_s_;
  std::vector<double> f_hz_, power_, weight_, fixed_, white_;
  std::vector<Part> parts_;
  bool free_white_ = true;
  bool floor_ = false;
  double start_ = 1.0;
};

/// Peaks over a grid of frequencies and qualities, and their densities in the bins of every length of recording.
class PeakGrid {
 public:
  PeakGrid(double low_hz, double high_hz, double dt_s);
  /// Where a peak would raise the likelihood fastest, by the score test; frequency 0 where none would raise it.
  [[nodiscard]] Peak best(const StackedSpectra& stacked, const std::vector<double>& expected);

 private:
  const Eigen::MatrixXd& densities_of(const StackedSpectra& stacked, const StackedSpectra::Part& part);

  double dt_s_;
  std::vector<Peak> peaks_;
  std::map<std::size_t, Eigen::MatrixXd> densities_;  ///< by samples of a recording: bins x peaks
};

/// The likelihood's top in frequency (up to `high_hz`) and quality, from a place near it.
[[nodiscard]] Peak refined(const StackedSpectra& stacked, Peak peak, double high_hz);

/// Standard deviations of ln sigma, ln f and ln Q from the curvature of the likelihood, every other level the best.
[[nodiscard]] std::array<double, 3> deviations_of(const StackedSpectra& stacked, const Peak& peak, double variance);

}  // namespace driftlab::investigate
