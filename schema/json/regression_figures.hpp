#pragma once
/// The figures of a regression run: what changed at each averaging time, beside the margin.
#include "schema/json/figures.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// The axis of a unit under its condition, as people write it: `gyroscope z, static`.
[[nodiscard]] std::string unit_name(const Json& unit);

/// For each unit of the document: the ratio of the Allan deviations with its interval, one and the margin. `axis`: of
/// the units of this axis alone; empty: of all. Throws Json::exception where the document is not as driftlab writes it.
[[nodiscard]] std::vector<NamedFigure> figures_of_regression(const Json& document, const std::string& axis);

}  // namespace driftlab
