#pragma once
/// Scenarios as the command line names them: by name, or as a file.
#include "core/navigate/outage_scenario.hpp"

namespace driftlab::cli {

/// Errors: NotFound (no such name or file), ParseError, and those of the document.
[[nodiscard]] Result<OutageScenario> read_scenario(const std::string& name_or_path);

}  // namespace driftlab::cli
