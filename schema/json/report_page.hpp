#pragma once
/// One page of HTML of a result, in one file: no script, no outside reference, printed on A4.
#include "schema/json/json.hpp"

#include <string>

namespace driftlab {

/// Of a characterisation (a recording, or the recordings of a device), an investigation, a regression run, an outage
/// evaluation or a parameter table. The verdict sentences are those of core/campaign/verdict.hpp, or what the document
/// itself holds. `device`: its name, may be empty. `tables`: what stands under the figures as it is, may be empty.
/// Errors: those of figures_of; Internal (a document that driftlab has not written).
[[nodiscard]] Result<std::string> report_page(const Json& document, const std::string& device,
                                              const std::string& tables);

}  // namespace driftlab
