#pragma once
/// The figures of an outage evaluation: errors at the ends of the outages.
#include "schema/json/figures.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// The mean horizontal error of each filter at the end of each outage, filters side by side. Throws
/// Json::exception where the document is not as driftlab writes it.
[[nodiscard]] std::vector<NamedFigure> figures_of_outages(const Json& document);

}  // namespace driftlab
