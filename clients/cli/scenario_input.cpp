#include "clients/cli/scenario_input.hpp"

#include "clients/cli/json_file.hpp"
#include "schema/json/outage_scenario.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace driftlab::cli {

Result<Json> scenario_document(const std::string& name_or_path) {
  const auto& names = scenario_names();
  if (std::find(names.begin(), names.end(), name_or_path) != names.end()) {
    return Json(name_or_path);
  }
  std::error_code unknown;
  if (!std::filesystem::exists(name_or_path, unknown)) {
    return fail(ErrorCode::NotFound, "There is no scenario and no file '" + name_or_path +
                                         "'; scenarios are paper, paper-position-only, paper-nhc and paper-s-curves.");
  }
  return read_json_file(name_or_path, "a scenario");
}

Result<OutageScenario> read_scenario(const std::string& name_or_path) {
  const auto document = scenario_document(name_or_path);
  if (!document) {
    return fail(document.error());
  }
  Faults faults;
  OutageScenario scenario = scenario_or_name(*document, "", faults);
  if (!faults.none()) {
    return fail(in_file(name_or_path, faults.error()));
  }
  return scenario;
}

}  // namespace driftlab::cli
