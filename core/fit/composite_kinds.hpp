#pragma once
/// The kinds of process that a search for a composite model offers (core/fit/composite_search.hpp).
///
/// These are all registered kinds but the first-order low-pass, which no curve tells from a Gauss-Markov process.
/// Ranges of shapes are those of the registry, narrowed to what a curve can tell: averages of up to 32 samples,
/// low-passes of corners below the sampling rate, Gauss-Markov processes no slower than the record, resonances of a
/// quality of at most 200. Of band-limited noise a model holds one of each kind.
#include "core/fit/composite_basis.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace driftlab {

/// Kinds with their shapes' ranges for a record of `samples`.
[[nodiscard]] std::vector<CompositeKind> composite_kinds(double dt_s, std::size_t samples);

/// The basis for these half lengths, made once: the last few are kept, so that the channels of a recording share one.
/// Thread safe.
[[nodiscard]] std::shared_ptr<const CompositeBasis> composite_basis(std::span<const std::size_t> half,
                                                                    std::size_t samples, double dt_s);

}  // namespace driftlab
