#pragma once
/// Is a series one noise throughout? A test for jumps of its level and for changes of its strength, with their times.
///
/// Null hypothesis: increments are stationary (white noise, quantization noise, Gauss-Markov processes, random walks,
/// flicker and their sums); single samples may be gross errors.
///
/// Jump: levels are the means of blocks of 48 (384, 3072) samples, in which what is far from the block's middle counts
/// as four standard deviations. Under the null the difference of the levels of blocks b and b + 2 has the same law for
/// every b; one that is more than 8 times the robust standard deviation (1.4826 median absolute deviation) of all is a
/// jump. A random walk makes these differences large, and with them their deviation.
///
/// Strength: |c| of non-overlapping Haar coefficients at half lengths 1, 8 and 64, medians of three successive ones.
/// The largest deviation of their cumulative sum from a straight line, in standard deviations, is under the null the
/// supremum of a Brownian bridge (Inclan and Tiao 1994, JASA 89; here on |c|, which gross errors move less than
/// squares). Its variance is estimated from differences of 32 successive batch means (von Neumann 1941), which a change
/// does not inflate; the estimate has 31 degrees of freedom, so that 2.6 is asked for where 1.95 would be 0.1 %.
///
/// A series with a change is cut there and both parts are tested again, until nothing is found or a part is shorter
/// than 1,500 samples. False alarms: tests/ACCURACY.md. A sensor that moves, warms up or is switched is reported as not
/// stationary; the test does not say why.
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

/// Where the noise is not the same before and after.
struct NoiseChange {
  enum class Kind {
    Jump,  ///< of the level: `size` is by how much [channel unit]
    Level  ///< of the noise: `size` is its standard deviation after over that before
  };
  Kind kind = Kind::Jump;
  std::size_t sample = 0;  ///< the first of the new noise, on the grid; to some 10 samples for a jump
  double size = 0.0;
  double half_s = 0.0;     ///< half length of the coefficients that show it [s]; of a jump that of the levels
  double statistic = 0.0;  ///< standard deviations (a jump), or supremum of the bridge

  /// After the first sample of a grid at `dt_s`.
  [[nodiscard]] double time_s(double dt_s) const { return static_cast<double>(sample) * dt_s; }
  friend bool operator==(const NoiseChange&, const NoiseChange&) = default;
};

struct Stationarity {
  bool tested = false;               ///< false: too short, or constant
  std::vector<NoiseChange> changes;  ///< by time; empty: one noise as far as the test sees
  /// The longest part between two changes, samples [first, last) of the grid: what should be analysed alone.
  std::size_t first = 0;
  std::size_t last = 0;

  /// Where that part begins and ends, after the first sample of a grid at `dt_s`.
  [[nodiscard]] double first_s(double dt_s) const { return static_cast<double>(first) * dt_s; }
  [[nodiscard]] double last_s(double dt_s) const { return static_cast<double>(last) * dt_s; }
};

/// At least this many samples are tested.
inline constexpr std::size_t kFewestStationary = 1500;

/// `samples` evenly spaced at `dt_s`, finite, none missing (a completed series where some are). Deterministic. O(N)
/// time for a series without changes, some 5 ms for 10^6 samples.
[[nodiscard]] Stationarity test_stationarity(std::span<const double> samples, double dt_s);

/// What was found, in sentences: each change (at most four of them) and the part to analyse alone. Empty: nothing.
[[nodiscard]] std::vector<std::string> describe(const Stationarity& found, double dt_s);

}  // namespace driftlab
