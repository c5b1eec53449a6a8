#pragma once
/// The candidates of one curve, fitted under one covariance and one discrepancy.
///
/// First every candidate is fitted at delta = 0, smaller models before those that contain them. If the J test rejects
/// none of them at 0.01, delta stays 0. Else delta is the value at which L of the largest candidate that the curve can
/// test equals its degrees of freedom, and every candidate is fitted again with it. So the distances of nested models
/// are ordered, and no model is penalised for a misfit that all candidates share.
#include "core/fit/candidate.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"

#include <Eigen/Core>

#include <memory>
#include <span>
#include <vector>

namespace driftlab {

struct CandidateSet {
  std::shared_ptr<const WhitenedCurve> curve;  ///< with the discrepancy of the set
  std::vector<Candidate> candidates;           ///< those with a positive component, smaller models first
};

/// `structures` without repetition, none with more parameters than the curve has rows. `sd`: of the variances, for the
/// diagonal weights. Error: Cancelled, polled before each fit.
[[nodiscard]] Result<CandidateSet> fit_candidates(const WaveletMoments& moments,
                                                  std::span<const ModelStructure> structures, const Eigen::VectorXd& sd,
                                                  CurveCovariance curve, const RunControl& control = {});

/// Finds the discrepancy of a set fitted at delta = 0, and fits its candidates again where it is not 0. Error:
/// Cancelled.
[[nodiscard]] Status forgive(const WaveletMoments& moments, CandidateSet& set, const RunControl& control = {});

/// A model by itself, with a discrepancy of its own. Its log_fit is null where it has no positive component.
[[nodiscard]] Candidate fit_alone(const WaveletMoments& moments, const ModelStructure& structure,
                                  const Eigen::VectorXd& sd, CurveCovariance curve);

/// Sets the own distance of every candidate that has none, where the set has no discrepancy.
void measure_by_own(const WaveletMoments& moments, CandidateSet& set, const CovarianceLaw& covariance_of);

/// To be called when another search has lowered the minimum of candidate `lowered`: refits the models that contain it
/// from there, so that the distances of nested models stay ordered.
void spread(const WaveletMoments& moments, CandidateSet& set, std::size_t lowered);

}  // namespace driftlab
