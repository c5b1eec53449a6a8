#pragma once
/// Stepwise search for a model over every registered process, beyond the listed candidates.
///
/// Starting from the best candidate so far, every model with one process more, one less or one exchanged is fitted. The
/// best of them by the criterion (candidate.hpp) is the next starting point, until no neighbour is better. The penalty
/// p ln N of the criterion ends the search; no model is fitted twice. The exchanges are needed: without them the search
/// stays at a Gauss-Markov process that stands in for a random walk.
///
/// The search is local. A pair of processes that helps only together is not found; the listed candidates are there for
/// such cases. The model found was chosen among some 30, and its intervals and J test take no account of that choice.
#include "core/fit/candidate_set.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"

#include <vector>

namespace driftlab {

/// Structures one process away from `from`: with one process more, and with each of its processes replaced by another
/// or left out. Structures with more parameters than `most_parameters`, more than three shapes, or no process are
/// excluded.
[[nodiscard]] std::vector<ModelStructure> neighbouring_structures(const ModelStructure& from,
                                                                  std::size_t most_parameters);

/// Adds every model fitted on the way to `set`, which must not be empty, and ranks by their own distances. Error:
/// Cancelled, polled before each fit. The cost is 10 to 30 fits a step, with some 2 to 5 steps.
[[nodiscard]] Status search_models(const WaveletMoments& moments, const Eigen::VectorXd& sd,
                                   const CovarianceLaw& covariance_of, CandidateSet& set,
                                   const RunControl& control = {});

}  // namespace driftlab
