#pragma once
/// The over-identification test of a fit (Hansen 1982), and the verdict that follows from it.
#include "core/fit/candidate.hpp"
#include "core/fit/characterisation.hpp"

#include <optional>
#include <string>

namespace driftlab {

/// A model that is wrong by no more than this share of the variances describes them.
inline constexpr double kDescribed = 0.02;

/// L of a fit without the scales that hold hardly more than one degree of freedom, such as the last one of 2^k samples,
/// which has a single coefficient. The logarithm of a chi-square of one degree is too skew for a sum of squares: with
/// it the test rejects 5 to 7 % of true models at a nominal 5 %, and 1.1 to 2 % at 1 %.
[[nodiscard]] double j_statistic(const LogFit& fit);

/// The test of the least L at delta = 0; empty where fewer than two degrees of freedom are left. Its size at a nominal
/// 5 %: tests/ACCURACY.md.
[[nodiscard]] std::optional<JTest> j_test(const Candidate& candidate);

/// Degrees of freedom of L: the rows of the curve less the parameters of a fit, at least 1.
[[nodiscard]] double distance_dof(const Candidate& candidate);

/// The relative error of the variances that a fit leaves: 0 where the J test does not reject, the discrepancy of the
/// curve where L does not reject with it, else that at which the fit's L would equal its degrees of freedom.
[[nodiscard]] double own_discrepancy(const Candidate& candidate);

/// The verdict on a fit with a discrepancy of its own: ModelFit::verdict.
[[nodiscard]] std::string verdict_of(const std::optional<JTest>& test, double discrepancy);

}  // namespace driftlab
