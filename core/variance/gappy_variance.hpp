#pragma once
/// Haar wavelet variances of a record with missing samples, estimated without a model: the mean of W^2 over the filter
/// positions that touch no gap. Unbiased where samples are missing independently of their values; efficient while most
/// windows are whole, and impossible once none is. Longer scales need a model (core/fit/sample_wise_variance.hpp).
#include "core/signal/gappy_samples.hpp"
#include "core/signal/progress.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace driftlab {

struct WholeWindows {
  double variance = 0.0;
  std::size_t windows = 0;  ///< how many touch no gap
  double share = 0.0;       ///< of all windows
};

/// Whole windows of one record at several scales. Holds one double per grid point: the sums of the samples up to it,
/// about the mean of the recorded ones.
class WholeWindowScan {
 public:
  explicit WholeWindowScan(const GappySamples& samples);

  /// Windows of half length `half` that touch no gap. O(stretches without a gap).
  [[nodiscard]] std::size_t windows(std::size_t half) const;
  /// At half length `half`, 2 half <= grid; nothing where no window is whole. O(N).
  [[nodiscard]] std::optional<WholeWindows> at(std::size_t half) const;
  /// At several half lengths, in one pass over the record. `control.stop` is polled every 65,536 samples; a stopped
  /// pass gives what it has.
  [[nodiscard]] std::vector<std::optional<WholeWindows>> at(std::span<const std::size_t> half,
                                                            const RunControl& control = {}) const;

 private:
  std::size_t size_;
  std::unique_ptr<double[]> prefix_;  ///< sums of 0, 1, .. samples; where one is missing 0 is added
  std::vector<std::size_t> stretch_;  ///< lengths of the stretches without a gap, in order
  std::vector<std::size_t> start_;    ///< and where they begin
};

}  // namespace driftlab
