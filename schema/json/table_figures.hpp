#pragma once
/// The figures of a parameter table: each parameter under each condition.
#include "schema/json/figures.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// One for each parameter of the table, against rate or acceleration; where conditions of several kinds have a size,
/// one for each kind, with those at rest in all. `parameter`: of this alone; empty: of all. Throws Json::exception
/// where the document is not as driftlab writes it.
[[nodiscard]] std::vector<NamedFigure> figures_of_table(const Json& document, const std::string& parameter);

/// How a table came about: its model, `Allan variance`, or empty where it does not say.
[[nodiscard]] std::string method_of_table(const Json& table);

/// Of the tables of all axes of a sensor, named by their axis; of several sensors by both.
[[nodiscard]] std::vector<NamedFigure> figures_of_tables(const Json& document, const std::string& parameter);

}  // namespace driftlab
