#pragma once
/// What the recordings of a characterisation document say together (core/campaign/campaign_summary.hpp): read from the
/// document, and written into it.
#include "core/analysis/characterise.hpp"
#include "core/campaign/campaign_summary.hpp"
#include "schema/json/json.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// The sensor axes of a characterisation document in order of appearance; channels without a stated axis stand each
/// for themselves, under their column name. Error: Internal, for a document that driftlab has not written.
[[nodiscard]] Result<std::vector<SensorSources>> sensors_of(const Json& characterisation);

/// Adds the summary to the document of its recordings as `replicates` and `trends`.
void add_summary(Json& characterisation, const CampaignSummary& summary);

/// The pooled sensor axes of a characterisation document with a summary; none of one without. Error: Internal, for a
/// document that driftlab has not written.
[[nodiscard]] Result<std::vector<PooledSensor>> pooled_sensors_of(const Json& characterisation);

/// The notes and warnings of its recordings. Error: Internal, likewise.
[[nodiscard]] Result<std::vector<Remark>> remarks_of(const Json& characterisation);

}  // namespace driftlab
