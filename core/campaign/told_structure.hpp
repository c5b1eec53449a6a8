#pragma once
/// A comparison of structures by names, from fits as they are reported: of the conditions of a sensor axis
/// (pooled_sensor.hpp), or of recordings that somebody puts beside each other (core/analysis/compare_structures.hpp).
#include "core/campaign/pooled_sensor.hpp"
#include "core/campaign/reported_channel.hpp"
#include "core/campaign/structure.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// Names of the models that every row was fitted with, smaller ones first. At least one row.
[[nodiscard]] std::vector<std::string> shared_models(const std::vector<const std::vector<ReportedFit>*>& rows);

/// The criterion of a fit and its distance; not fitted where it has no criterion.
[[nodiscard]] StructureScore score_of(const ReportedFit& fit);

/// `labels`: of the rows, in the order of the scores.
[[nodiscard]] PooledStructure told_structure(const StructureChoice& choice, const std::vector<std::string>& models,
                                             const std::vector<std::string>& labels);

}  // namespace driftlab
