#pragma once
/// A stepwise search for the composite model of a curve, over every kind of process of the registry.
///
/// The curve is dense: four scales to the octave up to a quarter of the record, so that it tests models of ten
/// parameters, which fifteen octaves cannot. One covariance S serves all models: first that of a non-negative mixture
/// of the basis' processes, then that of the best model. A step offers every kind: non-negative least squares over a
/// scan of its shape, beside the components so far, give its start; the best of each kind is polished
/// (core/fit/composite_fit.hpp), and the model of the smallest L + 4 p is kept while that falls. Then components are
/// dropped whose removal costs less than 5 per parameter. A drift enters only if every model without it is rejected, a
/// resonance or sinusoid only at a line of the periodogram. A model is accepted if chi-square(scales -
/// parameters) exceeds its L with a probability of at least 0.01, and if at least four degrees of freedom are left.
///
/// Where nothing is accepted, the search is repeated with a discrepancy delta of the variances
/// (core/fit/discrepancy.hpp), the first of 1, 2, 5 and 10 % (`kDiscrepancyLadder`) at which L of some model is below
/// its degrees of freedom by that measure: the model then describes the curve within delta, and L is no test.
#include "core/fit/composite_covariance.hpp"
#include "core/fit/composite_fit.hpp"
#include "core/signal/progress.hpp"

#include <array>
#include <vector>

namespace driftlab {

/// Models with more parameters are not fitted: they could not be interpreted.
inline constexpr std::size_t kMostCompositeParameters = 12;

/// The discrepancies that are tried, one after the other, until a model describes the curve: relative errors of the
/// variances. The first asks whether a model is right.
inline constexpr std::array kDiscrepancyLadder{0.0, 0.01, 0.02, 0.05, 0.1};

struct CompositeFit {
  Composite model;
  double distance = 0.0;  ///< L
  std::size_t parameters = 0;
  double p = 0.0;  ///< of L; with a discrepancy a measure, no test
  [[nodiscard]] double cost() const { return distance + 4.0 * static_cast<double>(parameters); }
};

struct CompositeSearchResult {
  bool accepted = false;           ///< delta = 0 and p > 0.01
  double delta = 0.0;              ///< discrepancy of the variances; negative: not described within 10 %
  std::vector<CompositeFit> fits;  ///< best first: the chosen model, and those that fit as well within a cost of 4
  CurveCovariance curve;           ///< S under the chosen model
};

/// O(kinds x scan x steps) least squares of at most nine columns: some 30 ms at 60 scales. Deterministic.
[[nodiscard]] CompositeSearchResult search_composite(const CompositeBasis& basis, const CompositeCurve& curve,
                                                     const RunControl& control = {});

}  // namespace driftlab
