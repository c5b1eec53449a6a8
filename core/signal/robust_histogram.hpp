#pragma once
/// How the values of a series are distributed, in robust standard deviations.
///
/// The centre is the median, the unit 1.4826 times the median absolute deviation: the standard deviation of Gaussian
/// noise, which a few gross errors do not move (Hampel 1974). Beside the counts stands what Gaussian noise of that
/// width would give, so that tails, spikes and a coarse lattice show against it.
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace driftlab {

struct RobustHistogram {
  double median = 0.0;
  double sigma = 0.0;         ///< robust standard deviation [unit of the values]
  std::vector<double> edges;  ///< of the bins, in robust standard deviations from the median; one more than counts
  std::vector<std::size_t> counts;
  std::vector<double> gaussian;  ///< expected in each bin
  std::size_t below = 0;         ///< values beyond the first edge
  std::size_t above = 0;
};

/// `bins` >= 2 bins of equal width over [-8, 8]. Nothing for an empty series, and where more than half of the values
/// are equal: there is no width then. Values are finite. O(N) time, N doubles of memory.
[[nodiscard]] std::optional<RobustHistogram> robust_histogram(std::span<const double> values, std::size_t bins);

}  // namespace driftlab
