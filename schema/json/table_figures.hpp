#pragma once
/// The figures of a parameter table: each parameter under each condition.
#include "schema/json/figures.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// One for each parameter of the table, against rate or acceleration. `parameter`: of this alone; empty: of all. Throws
/// Json::exception where the document is not as driftlab writes it.
[[nodiscard]] std::vector<NamedFigure> figures_of_table(const Json& document, const std::string& parameter);

}  // namespace driftlab
