#pragma once
/// The slow stochastic part of a channel as independent states of one dimension each, and its exact whitening.
///
/// The states of a process at block length are a law of its kind (core/process/slow_law.hpp): exact for Gauss-Markov
/// processes and random walks, six Gauss-Markov processes for flicker noise.
#include "core/investigate/slow/block_series.hpp"
#include "core/process/process.hpp"
#include "core/process/slow_law.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab::investigate {

/// A slow process of a model, and the recordings in which it acts.
struct SlowComponent {
  Process process;                ///< of a kind with `add_block_states`
  std::vector<unsigned char> in;  ///< recordings it acts in; empty: all

  [[nodiscard]] const ProcessKind& kind() const { return *process.kind; }
  [[nodiscard]] bool acts_in(std::size_t r) const { return in.empty() || in[r] != 0; }
};

/// By the square of its level (sigma^2, K^2, B^2), which is what a fit walks, and its shape, ignored by kinds without
/// one.
[[nodiscard]] SlowComponent slow_component(const ProcessKind& kind, double square, double shape = 0.0,
                                           std::vector<unsigned char> in = {});

/// Raises a level to the root of `square` where it is below.
void raise_square(SlowComponent& component, double square);

/// The square of a kind's level at which the process has about the variance `variance` by the end of a record: the
/// variance itself for what is stationary, variance / longest_s for a random walk, whose level is per root second.
[[nodiscard]] double at_record_length(const ProcessKind& kind, double variance, double longest_s);

struct SlowModel {
  double white = 0.0;               ///< N^2 [SI^2 s]
  std::vector<double> white_scale;  ///< factor of N^2 per recording; empty: 1
  std::vector<SlowComponent> components;

  [[nodiscard]] std::size_t count(const ProcessKind& kind) const;
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

/// The states of recording r at block length.
[[nodiscard]] BlockStates block_states(const SlowModel& model, const BlockSeries& series, std::size_t r);
[[nodiscard]] BlockStates block_states(const SlowModel& model, const Blocks& blocks, std::size_t r);

}  // namespace driftlab::investigate
