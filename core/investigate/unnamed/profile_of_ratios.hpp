#pragma once
/// A profile of ratios by bins, its shrinkage towards 1, and its log likelihood on other data.
#include <cstddef>
#include <vector>

namespace driftlab::investigate {

/// Sums of `weight` values whose mean is 1 under the model and whose log likelihood under the ratio r is
///   -(weight) (ln r + mean/r):
/// ordinates of a periodogram, or squares of innovations, of which two count as one.
struct RatioBin {
  double weight = 0.0, sum = 0.0;
  RatioBin& operator+=(const RatioBin& other) {
    weight += other.weight;
    sum += other.sum;
    return *this;
  }
};

/// The mean ratio of all bins: under an automatic base a level that is no part of a profile.
[[nodiscard]] double level_of(const std::vector<RatioBin>& bins);
/// The bins of ratios over `level`.
[[nodiscard]] std::vector<RatioBin> at_level(std::vector<RatioBin> bins, double level);

struct RatioProfile {
  std::vector<double> value;  ///< drawn towards 1
  std::vector<double> se;     ///< of the plain ratios
};

/// Ratios by bin, with the prior variance by moments; 1 in a bin without data.
[[nodiscard]] RatioProfile profile_of(const std::vector<RatioBin>& bins);

/// Log likelihood gained on `bins` by a profile over the model [nat].
[[nodiscard]] double gain_of(const RatioProfile& profile, const std::vector<RatioBin>& bins);

}  // namespace driftlab::investigate
