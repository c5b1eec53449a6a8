#pragma once
/// What the populations of a model say, in one sentence that a production line can act on (core/campaign/verdict.hpp).
#include "core/campaign/population_report.hpp"
#include "core/campaign/verdict.hpp"

#include <optional>
#include <string>

namespace driftlab {

/// Names the devices that are outlying and their parameters, or says that none is. Details: mean and spread of N for
/// each sensor axis and condition that has a mean. Facts: the smallest p_holm of each device that is named.
[[nodiscard]] Verdict verdict_of(const PopulationReport& report);

/// By what a device is not of the line, in one sentence; nothing where it does not stand out.
[[nodiscard]] std::optional<std::string> standing_out(const PopulationReport& report, const std::string& device);

}  // namespace driftlab
