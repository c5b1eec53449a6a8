#pragma once
/// How each parameter of a table moves with the dynamics (core/fit/trends.hpp), as a document and as text.
#include "core/fit/trends.hpp"
#include "schema/json/json.hpp"

#include <string>

namespace driftlab {

/// Trends of a parameter table (schema/json/parameter_table.hpp): every column against |rate| over its static and
/// constant-rate rows, and against |angular acceleration| over its static and constant-angular-acceleration rows, where
/// there are two such rows that identify it. `{"device", "sensor", "axis", "method", "model", "trends": [...]}`; each
/// trend has points, the points left out with the reason, the tests and the relation in the unit of the column against
/// deg/s or deg/s^2. Rows marked as contaminated without robust values, and rows whose recordings disagree, take part
/// and are said.
[[nodiscard]] Json build_trends(const Json& table);

/// The `trends` of such a document as lines of a terminal: parameter, arrow, relation, tests.
[[nodiscard]] std::string trends_to_text(const Json& trends);

}  // namespace driftlab
