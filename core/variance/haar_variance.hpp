#pragma once
/// Overlapping Allan variance and Haar MODWT wavelet variance at all octaves.
///
/// At half length m the wavelet coefficient is W_t = (mean of the last m samples - mean of the m samples before)/2 for
/// t = 2m .. N. The unbiased MODWT estimator (Percival and Walden 2000, eq. 306b) is the mean of W_t^2 over its N - 2m
/// + 1 values. Twice that is the overlapping Allan variance at tau = m dt (NIST SP 1065 eq. 11), which therefore needs
/// no computation of its own.
#include "core/signal/progress.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// Wavelet variances [unit^2] at m = 1, 2, 4, ... . Scale j covers n = 2m = 2^j samples, for j = 1 .. floor(log2 N).
struct HaarVariance {
  std::size_t samples = 0;
  std::vector<std::size_t> half;  ///< m
  std::vector<double> variance;

  [[nodiscard]] std::size_t scales() const { return half.size(); }
  /// Number of coefficients behind scale index `j`.
  [[nodiscard]] std::size_t coefficients(std::size_t j) const { return samples - 2 * half[j] + 1; }
};

/// All octaves in one pass over the data.
///
/// `samples` must be free of NaN and bounded, which summarise() checks. Sums are formed relative to `pivot`; with the
/// mean as pivot even a bias of 10^6 sigma costs no digits. Fewer than 2 samples give no scale. The bits are the same
/// on every run. `control.stop` is polled every million samples; a stopped pass gives an empty curve, which the caller
/// recognises by asking the token.
///
/// Short scales are computed by a pyramid of pairwise sums inside blocks that fit the cache, long ones from prefix
/// sums. Each scale costs O(N) time (for all scales together, 14 to 18 vectorised sums of the array). Memory hardly
/// grows with the record: 9 MB, and 4 bytes for every thousand samples. Prefix sums older than 260,000 samples are
/// recomputed from the samples, so these may lie in a mapped file larger than the memory; blocks are read in order, at
/// the offsets 0, 2^19, 2^20, ... behind the newest.
[[nodiscard]] HaarVariance haar_variance(std::span<const double> samples, double pivot, const RunControl& control = {});

}  // namespace driftlab
