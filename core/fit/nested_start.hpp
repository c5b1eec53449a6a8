#pragma once
/// Where to look for the minimum of a model that has one process more than a model whose minimum is known.
///
/// At the smaller model's minimum a little of the new process lowers L to first order by a score: with the whitened
/// residual r and the new process's whitened share of the curve c, both freed of what the smaller model's own
/// coordinates can do, L falls by (c'r)^2/c'c at the level c'r/c'c if c'r > 0 (Rao 1948). The shapes of the new process
/// are scanned for the largest fall. Where no shape promises any, the minimum of the larger model is that of the
/// smaller, to first order: the process vanishes.
#include "core/fit/log_fit.hpp"

#include <vector>

namespace driftlab {

/// Models to start from: the smaller model at its minimum with the new process at the best two places of its range that
/// are not neighbours, best first; empty where no amount of it lowers L. 48 points for one shape, 10 to a shape for
/// more.
[[nodiscard]] std::vector<Model> starts_with_more(const WaveletMoments& moments, const LogFit& smaller,
                                                  const ProcessKind& added);

}  // namespace driftlab
