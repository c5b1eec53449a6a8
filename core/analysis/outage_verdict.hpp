#pragma once
/// What a comparison of filters through outages says, in one sentence that a person could act on.
///
/// Two filters are compared: the one with the smallest mean error, with the paper's M_stat(AV) where the scenario has
/// it, and else with the one of the largest. The gain is their paired difference (core/navigate/outage_evaluation.hpp);
/// it is claimed only if the whole 95 % interval lies below 0 and it is of practical size (outage_claims.hpp). Whether
/// the better filter knows its own error stands in the same sentence: what is built on a filter needs both.
#include "core/campaign/verdict.hpp"
#include "core/navigate/outage_claims.hpp"

#include <optional>
#include <vector>

namespace driftlab {

/// Share of outages that a 95 % ellipse must hold; below it the filter is too sure of itself. In the plane 90 % are
/// held where the errors' covariance is ln 0.05 / ln 0.10 = 1.30 times the filter's.
inline constexpr double kHonestShare = 0.90;

/// Mean NEES below which a filter is too shy: its covariance is at least twice that of its errors.
inline constexpr double kShyNees = 1.0;

/// Facts point into the evaluation's document (schema/outage-evaluation.schema.json). `evaluation` has a filter, and
/// each of its filters the same outages.
[[nodiscard]] Verdict verdict_of(const OutageEvaluation& evaluation, const std::optional<Attribution>& attribution,
                                 const std::vector<Claim>& claims);

}  // namespace driftlab
