#pragma once
/// Trends of a parameter table as lines of a terminal.
#include "core/campaign/trend_table.hpp"

#include <string>

namespace driftlab {

/// A line per trend: parameter, arrow, relation with its unit, tests, statement.
[[nodiscard]] std::string trends_to_text(const TrendTable& table);

}  // namespace driftlab
