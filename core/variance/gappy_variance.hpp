#pragma once
/// Haar wavelet variances of a record with missing samples, estimated without a model.
///
/// Two unbiased estimators are given. Whole windows: the mean of W^2 over the filter positions that touch no gap. It is
/// efficient while most windows are whole, and impossible once none is. Pairs (Mondal and Percival 2010, the estimator
/// for processes with stationary increments): every squared filter output is written as -1/2 sum_{l,l'} h_l h_l'
/// (x_{t-l} - x_{t-l'})^2, and the term of each pair is divided by the relative frequency with which both samples at
/// that lag are present. It works at any scale, but its scatter grows with the share of missing samples and it may come
/// out negative. It serves as a check of the model-based estimate (core/fit/sample_wise_variance.hpp). Both assume that
/// samples are missing independently of their values.
#include "core/signal/gappy_samples.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace driftlab {

struct WholeWindows {
  double variance = 0.0;
  std::size_t windows = 0;  ///< how many touch no gap
  double share = 0.0;       ///< of all windows
};

/// Whole windows of one record at several scales: the samples are centred once.
class WholeWindowScan {
 public:
  explicit WholeWindowScan(const GappySamples& samples);

  /// Windows of half length `half` that touch no gap. O(stretches without a gap).
  [[nodiscard]] std::size_t windows(std::size_t half) const;
  /// At half length `half`, 2 half <= grid; nothing where no window is whole. O(N).
  [[nodiscard]] std::optional<WholeWindows> at(std::size_t half) const;

 private:
  std::vector<double> centred_;       ///< about the mean of the recorded samples; 0 where missing
  std::vector<std::size_t> stretch_;  ///< lengths of the stretches without a gap, in order
  std::vector<std::size_t> start_;    ///< and where they begin
};

/// The same at one scale.
[[nodiscard]] std::optional<WholeWindows> whole_window_variance(const GappySamples& samples, std::size_t half);

/// At half length `half`; nothing where no pair at some lag below 2 half is there. O(N half).
[[nodiscard]] std::optional<double> pairwise_variance(const GappySamples& samples, std::size_t half);

}  // namespace driftlab
