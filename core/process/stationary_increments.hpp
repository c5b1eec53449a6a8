#pragma once
/// Simulation of a process whose increments are stationary, from their autocovariance, by circulant embedding (Davies
/// and Harte 1987; Wood and Chan 1994).
///
/// A circle of twice a power of two of increments is drawn in the frequency domain, where they are independent; those
/// of the record have their second moments exactly, and so have all differences of the path. An eigenvalue of the
/// circle below zero is rounding and is taken for zero.
#include "core/process/random.hpp"

#include <cstddef>
#include <span>

namespace driftlab {

/// How many autocovariances a path of `samples` samples takes: the least power of two that is not smaller, and one.
[[nodiscard]] std::size_t embedding_lags(std::size_t samples);

/// Adds a path that starts at 0. `covariance`: of the increments at the lags 0, 1, ..., embedding_lags(out.size()) of
/// them. O(n log n) time, 4 n complex numbers; two normal numbers per point of the circle.
void add_path_of_increments(std::span<const double> covariance, Random& random, std::span<double> out);

}  // namespace driftlab
