#pragma once
/// What the commands on studies ask of the core, from what was read of the command line.
#include "clients/cli/input.hpp"
#include "core/analysis/investigate.hpp"

#include <string>

namespace driftlab::cli {

/// Errors: those of baseline_from_json.
[[nodiscard]] Result<InvestigationRequest> investigation_request(const Inputs& inputs);

/// False where the file cannot be written whole.
[[nodiscard]] bool write_file(const std::string& path, const std::string& text);

}  // namespace driftlab::cli
