#pragma once
/// Scenarios as the command line names them: by name, or as a file.
#include "core/analysis/evaluate_outages.hpp"
#include "schema/json/json.hpp"

namespace driftlab::cli {

/// A known name as a text, or the document of the file: what `scenario` of a request may be. Errors: NotFound (no such
/// name or file), ParseError.
[[nodiscard]] Result<Json> scenario_document(const std::string& name_or_path);

/// Errors: those of scenario_document, and of the document.
[[nodiscard]] Result<OutageScenario> read_scenario(const std::string& name_or_path);

}  // namespace driftlab::cli
