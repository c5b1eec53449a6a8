#pragma once
/// Stepwise search for a model over every registered process, beyond the candidates that somebody listed.
///
/// From the best candidate so far, every model with one process more, one less or one exchanged is fitted, the best by
/// the criterion (candidate.hpp) is the next start, until no neighbour is better. The penalty p ln N of the criterion
/// is what stops it; neighbours already fitted are not fitted twice. It is a local search: a pair of processes that
/// helps only together is not found, which the listed candidates are there for. What it finds was chosen among some 30
/// models, so its intervals and its J-test are those of a model that was looked for. Without exchanges it stays at a
/// Gauss-Markov process that stands in for a random walk.
#include "core/fit/candidate.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"

#include <vector>

namespace driftlab {

/// Structures one process away from `from`: one more, then for each of its processes another in its place or none. None
/// with more parameters than `most_parameters`, more than three shapes, or no process at all.
[[nodiscard]] std::vector<ModelStructure> neighbouring_structures(const ModelStructure& from,
                                                                  std::size_t most_parameters);

/// `known` (not empty) and everything fitted on the way. Error: Cancelled, polled before each fit.
/// Cost: 10 to 30 fits a step, some 2 to 5 steps.
[[nodiscard]] Result<std::vector<Candidate>> search_models(const WaveletMoments& moments, const Eigen::VectorXd& sd,
                                                           const CovarianceLaw& covariance_of,
                                                           std::vector<Candidate> known,
                                                           const RunControl& control = {});

}  // namespace driftlab
