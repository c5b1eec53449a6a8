#pragma once
/// The outage evaluation as a document (spec/results.md; schema/outage-evaluation.schema.json).
#include "core/analysis/evaluate_outages.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// The document: the scenario with every model spelled out, the filters, their differences, what that says of the
/// claims.
[[nodiscard]] Json to_json(const OutageReport& report);

/// Options of a request: `runs`, `seed`, `relative_precision`. `threads` is not one of them: it changes no result.
[[nodiscard]] OutageOptions outage_options_from_json(const Json& parameters, const std::string& pointer,
                                                     Faults& faults);
[[nodiscard]] Json to_json(const OutageOptions& options);

}  // namespace driftlab
