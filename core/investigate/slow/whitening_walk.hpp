#pragma once
/// The Kalman filter of one recording, walked from block to block: what `whiten` (slow_model.hpp) does, for series that
/// are made or used as the walk goes on and need not be kept.
#include "core/process/slow_law.hpp"

#include <cstddef>
#include <vector>

namespace driftlab::investigate {

/// One block of `width` series side by side: the innovations over their deviation to `out`, another place than `in`,
/// and the states behind the block. `state`: of the series one after the other, for each state. Where `inv_sd` is 0 the
/// block is empty.
using BlockWhitening = void (*)(std::size_t states, std::size_t width, const double* in, const double* phi,
                                const double* gain, double inv_sd, double* state, double* out);
[[nodiscard]] BlockWhitening block_whitening(std::size_t states);

class WhiteningWalk {
 public:
  /// Filters `width` series with the same gains; `states` must outlive the walk. `uniform`: every block is as full as
  /// the first, so that gains which no longer change hold for all blocks that follow.
  WhiteningWalk(const BlockStates& states, bool uniform, std::size_t width);

  /// Goes on to the next block, of which the share `filled` holds samples. O(states^2).
  void next(double filled);
  /// The innovation of one series in this block over its deviation, 0 in an empty block; once per block and series.
  [[nodiscard]] double whitened(std::size_t series, double value) {
    const std::size_t m = gain_.size();
    double v = value;
    for (std::size_t i = 0; i < m; ++i) {
      v -= state_[i * width_ + series];
    }
    v = inv_sd_ > 0.0 ? v : 0.0;
    for (std::size_t i = 0; i < m; ++i) {
      double& state = state_[i * width_ + series];
      state = states_.phi[i] * (state + gain_[i] * v);
    }
    return v * inv_sd_;
  }
  /// The same of all series at once. `whitened` is another place than `values`.
  void whiten_all(const double* values, double* whitened) {
    whiten_(gain_.size(), width_, values, states_.phi.data(), gain_.data(), inv_sd_, state_.data(), whitened);
  }

  /// Gains do not change any more.
  [[nodiscard]] bool settled() const { return settled_; }
  [[nodiscard]] const std::vector<double>& gain() const { return gain_; }  ///< one per state
  [[nodiscard]] double variance() const { return variance_; }              ///< S; 0 for an empty block
  [[nodiscard]] double inv_sd() const { return inv_sd_; }                  ///< 1/sqrt(S); 0 for an empty block

 private:
  /// `States`: how many there are where they are few, else 0.
  template <std::size_t States>
  void advance(double filled);

  const BlockStates& states_;
  bool uniform_;
  std::size_t width_;
  BlockWhitening whiten_;
  std::vector<double> covariance_, sum_, gain_, state_;
  double variance_ = 0.0;
  double inv_sd_ = 0.0;
  std::size_t same_ = 0;
  bool first_ = true;
  bool settled_ = false;
};

}  // namespace driftlab::investigate
