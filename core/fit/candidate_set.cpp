#include "core/fit/candidate_set.hpp"

#include "core/fit/j_test.hpp"
#include "core/signal/sort_keeping_ties.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

namespace driftlab {
namespace {

constexpr int kMostRounds = 3;
/// L of the largest candidate and its degrees of freedom are equal to this.
constexpr double kEqual = 0.05;
constexpr double kFirstGuess = 0.02;

tl::unexpected<Error> cancelled_fit() { return fail(ErrorCode::Cancelled, "The fit of the models was cancelled."); }

/// The largest candidate that can be tested; of two as large the closer one.
const Candidate* largest_testable(const CandidateSet& set) {
  const Candidate* largest = nullptr;
  for (const Candidate& candidate : set.candidates) {
    const std::size_t size = candidate.structure.parameter_count();
    const bool larger =
        largest == nullptr || size > largest->structure.parameter_count() ||
        (size == largest->structure.parameter_count() && candidate.test_distance < largest->test_distance);
    if (larger && j_test(candidate)) {
      largest = &candidate;
    }
  }
  return largest;
}

bool any_accepted(const CandidateSet& set) {
  return std::any_of(set.candidates.begin(), set.candidates.end(), [](const Candidate& candidate) {
    const std::optional<JTest> test = j_test(candidate);
    return test && stands_at(test->p);
  });
}

/// The delta at which L of a candidate equals its degrees of freedom, by its own minima from where it is.
double discrepancy_of_minimum(const WaveletMoments& moments, const Candidate& candidate, const CurveCovariance& curve,
                              double first) {
  Model from = candidate.log_fit->model();
  const auto distance = [&](double delta) {
    const auto weighted = std::make_shared<const WhitenedCurve>(whitened(curve, delta));
    LogFit here(moments, candidate.log_fit->model(), weighted);
    LogFit diagonal(moments, candidate.diagonal.active(), weighted);
    const LogFit last(moments, from, weighted);
    const LogFit* best = here.minimum() <= diagonal.minimum() ? &here : &diagonal;
    best = best->minimum() <= last.minimum() ? best : &last;
    from = best->model();
    return best->minimum();
  };
  return find_discrepancy(distance, distance_dof(candidate), first);
}

}  // namespace

Result<CandidateSet> fit_candidates(const WaveletMoments& moments, std::span<const ModelStructure> structures,
                                    const Eigen::VectorXd& sd, CurveCovariance curve, const RunControl& control) {
  CandidateSet set;
  set.curve = std::make_shared<const WhitenedCurve>(whitened(std::move(curve), 0.0));
  std::vector<ModelStructure> rising(structures.begin(), structures.end());
  sort_keeping_ties(rising, [](const ModelStructure& a, const ModelStructure& b) {
    return a.parameter_count() < b.parameter_count();
  });
  for (std::size_t i = 0; i < rising.size(); ++i) {
    if (control.stop.stop_requested()) {
      return cancelled_fit();
    }
    control.report("fit " + model_name(rising[i]), static_cast<double>(i) / static_cast<double>(rising.size()));
    Candidate candidate = fit_candidate(moments, rising[i], sd, set.curve, set.candidates);
    if (candidate.log_fit) {
      set.candidates.push_back(std::move(candidate));
    }
  }
  return set;
}

Status forgive(const WaveletMoments& moments, CandidateSet& set, const RunControl& control) {
  if (largest_testable(set) == nullptr || any_accepted(set)) {
    return {};
  }
  for (int round = 0; round < kMostRounds; ++round) {
    if (control.stop.stop_requested()) {
      return cancelled_fit();
    }
    const Candidate& largest = *largest_testable(set);
    if (round > 0 && std::fabs(largest.fit.objective / distance_dof(largest) - 1.0) < kEqual) {
      break;  // else fitting all of them has found a better minimum of the largest, or one with fewer components
    }
    const double first = set.curve->delta > 0.0 ? set.curve->delta : kFirstGuess;
    const double delta = discrepancy_of_minimum(moments, largest, set.curve->curve, first);
    set.curve = std::make_shared<const WhitenedCurve>(whitened(set.curve->curve, delta));
    std::vector<Candidate> again;
    for (const Candidate& candidate : set.candidates) {
      if (control.stop.stop_requested()) {
        return cancelled_fit();
      }
      again.push_back(refit_candidate(moments, candidate, set.curve, again));
    }
    set.candidates = std::move(again);
  }
  return {};
}

Candidate fit_alone(const WaveletMoments& moments, const ModelStructure& structure, const Eigen::VectorXd& sd,
                    CurveCovariance curve) {
  const auto exact = std::make_shared<const WhitenedCurve>(whitened(std::move(curve), 0.0));
  Candidate candidate = fit_candidate(moments, structure, sd, exact);
  if (!candidate.log_fit) {
    return candidate;
  }
  const std::optional<JTest> test = j_test(candidate);
  if (!test || stands_at(test->p)) {
    return candidate;
  }
  const double delta = discrepancy_of_minimum(moments, candidate, exact->curve, kFirstGuess);
  return refit_candidate(moments, candidate, std::make_shared<const WhitenedCurve>(whitened(exact->curve, delta)));
}

void measure_by_own(const WaveletMoments& moments, CandidateSet& set, const CovarianceLaw& covariance_of) {
  if (set.curve->delta > 0.0) {
    return;
  }
  std::vector<Candidate*> rising;
  for (Candidate& candidate : set.candidates) {
    if (!candidate.own_distance) {
      candidate.own_distance = distance_under_own(moments, candidate, covariance_of);
    }
    rising.push_back(&candidate);
  }
  sort_keeping_ties(rising, [](const Candidate* a, const Candidate* b) {
    return a->structure.parameter_count() < b->structure.parameter_count();
  });
  for (std::size_t i = 0; i < rising.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (is_nested(rising[j]->structure, rising[i]->structure)) {
        constexpr double kUnknown = std::numeric_limits<double>::infinity();
        std::optional<double>& own = rising[i]->own_distance;
        own = std::min(own.value_or(kUnknown), rising[j]->own_distance.value_or(kUnknown));
      }
    }
  }
}

void spread(const WaveletMoments& moments, CandidateSet& set, std::size_t lowered) {
  set.candidates[lowered].settle();
  std::vector<std::size_t> larger;
  for (std::size_t i = 0; i < set.candidates.size(); ++i) {
    if (i != lowered && is_nested(set.candidates[lowered].structure, set.candidates[i].structure)) {
      larger.push_back(i);
    }
  }
  std::sort(larger.begin(), larger.end(), [&](std::size_t a, std::size_t b) {
    return set.candidates[a].structure.parameter_count() < set.candidates[b].structure.parameter_count();
  });
  for (const std::size_t i : larger) {
    set.candidates[i] = refit_candidate(moments, set.candidates[i], set.curve, set.candidates);
  }
}

}  // namespace driftlab
