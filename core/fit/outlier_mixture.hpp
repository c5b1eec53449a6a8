#pragma once
/// The distribution of one residual in a record that may hold gross errors. z = e/sqrt(V) is N(0, core) for a good
/// sample, and N(0, core + ratio_k) with probability weight_k for a sample with an additional error of size k.
///
/// The sizes are 3, 6, 12, ... standard deviations, so that any scale mixture of Gaussians from 3 sd upwards is well
/// approximated. Weights and core are estimated by the EM algorithm from the histogram of the residuals (Dempster,
/// Laird, Rubin 1977). A clean record gives weights near 0.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace driftlab {

/// Counts of |z|: 32 bins to the unit below 8, four to the octave above.
class ResidualHistogram {
 public:
  static constexpr std::size_t kFine = 256;
  static constexpr std::size_t kBins = kFine + 200;
  static constexpr double kFineEnd = 8.0;
  static constexpr double kPerUnit = static_cast<double>(kFine) / kFineEnd;

  void clear() { counts_.fill(0); }
  /// `magnitude` = |z|. What is no number is not counted: a sample near the end of what a double holds may be
  /// infinitely far from the model, in infinite units.
  void add(double magnitude) {
    if (magnitude < kFineEnd) {
      ++counts_[static_cast<std::size_t>(magnitude * kPerUnit)];
    } else if (!std::isnan(magnitude)) {
      ++counts_[bin_of(magnitude)];
    }
  }
  [[nodiscard]] static std::size_t bin_of(double magnitude);
  [[nodiscard]] static double centre(std::size_t bin);
  [[nodiscard]] static double lower_end(std::size_t bin);
  [[nodiscard]] std::uint64_t count(std::size_t bin) const { return counts_[bin]; }
  [[nodiscard]] std::uint64_t total() const;
  /// Centre of the last bin that holds something; 0 if none does.
  [[nodiscard]] double largest() const;

 private:
  std::array<std::uint64_t, kBins> counts_{};
};

struct OutlierMixture {
  static constexpr std::size_t kMostSizes = 24;
  static constexpr double kSmallestSize = 3.0;  ///< in standard deviations; each next is twice as large

  std::vector<double> ratio;   ///< squares of the sizes
  std::vector<double> weight;  ///< one per size; their sum is the share of gross errors
  double core = 1.0;

  /// Sizes up to `largest` standard deviations, small equal weights.
  [[nodiscard]] static OutlierMixture up_to(double largest);

  /// EM steps on the histogram, from here.
  void refine(const ResidualHistogram& histogram, int steps);

  [[nodiscard]] double outlier_share() const;
  /// Probability that a residual z carries an error.
  [[nodiscard]] double posterior(double z) const;
  /// Which size, given that it carries one; `u` uniform on (0, 1).
  [[nodiscard]] std::size_t pick_size(double z, double u) const;
};

/// The smallest |z| above which at most the share `rate` of residuals is expected to be good (Benjamini and Hochberg
/// 1995); infinite if there is none.
[[nodiscard]] double false_discovery_limit(const ResidualHistogram& histogram, double core, double rate);

}  // namespace driftlab
