#pragma once
/// The figures of an investigation: what was measured beside what the baseline and the extended model simulate.
#include "schema/json/figures.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// For each channel of the document: Allan deviation, spectrum and wavelet deviation over the baseline before and after
/// the findings, and the time course of one recording with the effect that was found; after these the profiles that
/// the extended model holds without a name. `channel`: of this alone; empty:
/// of all. Throws Json::exception where the document is not as driftlab writes it.
[[nodiscard]] std::vector<NamedFigure> figures_of_investigation(const Json& document, const std::string& channel);

}  // namespace driftlab
