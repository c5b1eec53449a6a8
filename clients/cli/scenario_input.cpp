#include "clients/cli/scenario_input.hpp"

#include "schema/json/outage_scenario.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

namespace driftlab::cli {

Result<Json> scenario_document(const std::string& name_or_path) {
  const auto& names = scenario_names();
  if (std::find(names.begin(), names.end(), name_or_path) != names.end()) {
    return Json(name_or_path);
  }
  const std::ifstream file(name_or_path, std::ios::binary);
  if (!file) {
    return fail(ErrorCode::NotFound, "There is no scenario and no file '" + name_or_path +
                                         "'; scenarios are paper, paper-position-only, paper-nhc and paper-s-curves.");
  }
  std::ostringstream text;
  text << file.rdbuf();
  return parse_json(text.str());
}

Result<OutageScenario> read_scenario(const std::string& name_or_path) {
  const auto document = scenario_document(name_or_path);
  if (!document) {
    return fail(document.error());
  }
  Faults faults;
  OutageScenario scenario = scenario_or_name(*document, "", faults);
  if (!faults.none()) {
    return fail(faults.error());
  }
  return scenario;
}

}  // namespace driftlab::cli
