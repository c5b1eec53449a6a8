#pragma once
/// The slow stochastic part of a channel as independent states of one dimension each, and its exact whitening.
///
/// Block means of L point samples of a Gauss-Markov process with phi = exp(-beta dt) have autocovariance
///   lag 0: s^2/L^2 [L + 2 sum_{k=1}^{L-1} (L-k) phi^k],   lag j >= 1: A phi^{L j},  A = s^2 phi^{1-L}
///   [(1-phi^L)/(L(1-phi))]^2:
/// an AR(1) of variance A and a white remainder (lag 0 minus A, not positive) that the white part absorbs. Block means
/// of a random walk have increments of variance q (2/3 + 1/(3 L^2)) and lag-one covariance q (1/6 - 1/(6 L^2)), q = K^2
/// L dt: a walk of step variance q and a white remainder -q (1 - 1/L^2)/6. Both are exact and reduce to the process at
/// L = 1. Flicker noise is six Gauss-Markov processes with correlation times spaced evenly in the logarithm.
#include "core/investigate/slow/block_series.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab::investigate {

enum class SlowKind {
  GaussMarkov,  ///< level = sigma^2, beta
  RandomWalk,   ///< level = K^2; zero at the first sample of the file
  Flicker,      ///< level = B^2
  Offset,       ///< level = sigma^2 of a constant drawn per recording
};

struct SlowComponent {
  SlowKind kind = SlowKind::GaussMarkov;
  double level = 0.0;
  double beta = 0.0;              ///< [1/s]; Gauss-Markov only
  std::vector<unsigned char> in;  ///< recordings it acts in; empty: all
  [[nodiscard]] bool acts_in(std::size_t r) const { return in.empty() || in[r] != 0; }
};

struct SlowModel {
  double white = 0.0;               ///< N^2 [SI^2 s]
  std::vector<double> white_scale;  ///< factor of N^2 per recording; empty: 1
  std::vector<SlowComponent> components;

  [[nodiscard]] std::size_t count(SlowKind kind) const;
};

/// Columns on the blocks of a series: one row-major matrix (blocks x columns) per recording.
struct BlockColumns {
  std::size_t width = 0;
  std::vector<std::vector<double>> rows;

  /// `width` zero columns shaped like the series.
  [[nodiscard]] static BlockColumns zeros(const BlockSeries& series, std::size_t width);
};

/// Inner products of the columns over recording r (width x width).
[[nodiscard]] Eigen::MatrixXd gram_of(const BlockColumns& columns, std::size_t r);

/// Innovations divided by their standard deviations, and what goes with them.
struct Whitened {
  BlockColumns columns;         ///< empty blocks give zero rows
  std::vector<double> log_var;  ///< log S per block, all recordings in order; 0 for empty blocks
  double sum_log_var = 0.0;
  std::size_t used = 0;  ///< blocks that are not empty
};

/// Kalman filter of the model over every recording, applied to each column alike (it is linear): exact whitening.
/// Gains are shared by recordings of one pattern and frozen once they no longer change. O(blocks (states columns +
/// states^2)). `model.white` must be positive.
[[nodiscard]] Whitened whiten(const BlockSeries& series, const SlowModel& model, const BlockColumns& columns);

/// W'v per block: the transpose of the same filter, applied to one whitened column. With it the inner products of a
/// whitened series with every whitened *step* are running sums.
[[nodiscard]] std::vector<double> whiten_transposed(const BlockSeries& series, const SlowModel& model, std::size_t r,
                                                    std::span<const double> whitened);

/// The states of a model at block length: transition, step variance, first variance, white remainder.
struct BlockStates {
  std::vector<double> phi, q, p0;
  double white = 0.0;  ///< N^2 / (L dt)
  double remainder = 0.0;
};
[[nodiscard]] BlockStates block_states(const SlowModel& model, const BlockSeries& series, std::size_t r);

}  // namespace driftlab::investigate
