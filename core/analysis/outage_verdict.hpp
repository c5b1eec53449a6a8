#pragma once
/// What a comparison of filters through outages says, in one sentence that a person could act on.
///
/// The filter with the smallest mean error is compared with the paper's M_stat(AV), or, in a scenario without that
/// filter, with the one of the largest mean error. The gain is their paired difference
/// (core/navigate/outage_evaluation.hpp); it is claimed only if the whole 95 % interval lies below 0 and it is of
/// practical size (outage_claims.hpp). Whether the better filter knows its own error stands in the same sentence: what
/// is built on a filter needs both.
#include "core/campaign/verdict.hpp"
#include "core/navigate/outage_claims.hpp"

#include <optional>
#include <vector>

namespace driftlab {

/// A filter is called too sure of itself if its 95 % ellipses hold the truth in a smaller share of outages than this.
/// In the plane they hold 90 % if the covariance of the errors is ln 0.05 / ln 0.10 = 1.30 times that of the filter.
inline constexpr double kHonestShare = 0.90;

/// A filter is said to have a larger ellipse than it needs if its mean NEES, of which 2 is right in the plane, is below
/// this: its covariance is then at least twice that of its errors.
inline constexpr double kShyNees = 1.0;

/// Facts point into the evaluation's document (schema/outage-evaluation.schema.json). `evaluation` has a filter, and
/// each of its filters the same outages.
[[nodiscard]] Verdict verdict_of(const OutageEvaluation& evaluation, const std::optional<Attribution>& attribution,
                                 const std::vector<Claim>& claims);

}  // namespace driftlab
