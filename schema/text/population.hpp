#pragma once
/// Populations of a model for people and spreadsheets.
#include "core/campaign/population_report.hpp"

#include <string>

namespace driftlab {

/// The verdict, then per parameter a line with mean, spread and prediction, and below it a line for every outlying
/// device.
[[nodiscard]] std::string populations_to_text(const PopulationReport& report);

/// The verdict, a pipe table with a row for each parameter, and the details of the verdict.
[[nodiscard]] std::string populations_to_markdown(const PopulationReport& report);

/// A row for each device and parameter: estimate, place, p and flag; RFC 4180.
[[nodiscard]] std::string populations_to_csv(const PopulationReport& report);

}  // namespace driftlab
