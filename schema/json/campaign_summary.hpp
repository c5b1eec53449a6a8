#pragma once
/// What the recordings of a characterisation document say together (core/campaign/campaign_summary.hpp): read from the
/// document, and written into it.
#include "core/campaign/campaign_summary.hpp"
#include "schema/json/json.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// The sensor axes of a characterisation document in order of appearance; channels that nobody named by axis stand each
/// for themselves, under their column name. Error: Internal, for a document that driftlab has not written.
[[nodiscard]] Result<std::vector<SensorSources>> sensors_of(const Json& characterisation);

/// Adds the summary to the document of its recordings as `replicates` and `trends`.
void add_summary(Json& characterisation, const CampaignSummary& summary);

/// The pooled result of a sensor axis in a characterisation document with a summary; nothing where it has none. Error:
/// Internal, for a document that driftlab has not written.
[[nodiscard]] Result<std::optional<PooledSensor>> pooled_of(const Json& characterisation, const SensorSources& sensor);

}  // namespace driftlab
