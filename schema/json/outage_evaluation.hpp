#pragma once
/// The outage evaluation as a document (spec/results.md; schema/outage-evaluation.schema.json), and as text.
#include "core/navigate/outage_evaluation.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// `scenario` is what was asked for: a name or the scenario's document.
[[nodiscard]] Json to_json(const OutageEvaluation& evaluation, Json scenario);

/// Options of a request: `runs`, `seed`, `relative_precision`. `threads` is not one of them: it changes no result.
[[nodiscard]] OutageOptions outage_options_from_json(const Json& parameters, const std::string& pointer,
                                                     Faults& faults);
[[nodiscard]] Json to_json(const OutageOptions& options);

/// The comparison as aligned plain text: filters, outages, paired differences, attribution, claims.
[[nodiscard]] std::string outage_text(const OutageEvaluation& evaluation);

}  // namespace driftlab
