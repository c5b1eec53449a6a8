#pragma once
/// What a slow process is to a recording that is looked at in blocks of samples: two optional laws of a kind of process
/// (core/process/process.hpp), by which an investigation fits it, whitens it and compares spectra with it.
///
/// Both are linear in the square of the process's level and take that square, `square` [unit^2 ...], because a fit
/// walks it. `shape` is the second parameter [1/s], and the last; ignored by kinds that have one parameter.
///
/// Means over blocks of L samples of a process that is slow against the sample have the second moments of a sum of
/// independent first-order autoregressions, one state each, and of a white remainder that the white noise beside the
/// process absorbs. For a Gauss-Markov process and a random walk this is exact, and at L = 1 it is the process itself.
#include <cstddef>
#include <vector>

namespace driftlab {

/// The blocks of one recording.
struct Blocks {
  double dt_s = 0.0;       ///< sample interval
  std::size_t block = 1;   ///< L, samples per block
  double start_s = 0.0;    ///< time of the first block's first sample, from the first sample of the file
  double longest_s = 0.0;  ///< length of the longest recording of the study

  [[nodiscard]] double block_s() const { return dt_s * static_cast<double>(block); }
};

/// Independent states at block length, x_{b+1} = phi x_b + w_b, one entry of each list per state.
struct BlockStates {
  std::vector<double> phi;
  std::vector<double> q;   ///< variance of a step [unit^2]
  std::vector<double> p0;  ///< variance in the first block [unit^2]
  double white = 0.0;      ///< of white noise beside the processes, N^2 / (L dt) [unit^2]
  double remainder = 0.0;  ///< variance of block means that no state holds; may be negative [unit^2]
};

/// Adds the states of a process.
using AddBlockStates = void (*)(double square, double shape, const Blocks& blocks, BlockStates& states);

/// Expected periodogram [unit^2 s] at f_hz of a record of `samples` samples, leakage of its two ends included.
using ExpectedPeriodogram = double (*)(double square, double shape, double f_hz, double dt_s, double samples);

}  // namespace driftlab
