#pragma once
/// Trends of a parameter table as lines of a terminal.
#include "core/campaign/trend_table.hpp"

#include <string>

namespace driftlab {

/// A line per trend: parameter, arrow, relation with its unit, tests, statement.
[[nodiscard]] std::string trends_to_text(const TrendTable& table);

/// A row per trend with its relation, tests and statement; RFC 4180.
[[nodiscard]] std::string trends_to_csv(const TrendTable& table);

/// The same as a pipe table for papers and issues.
[[nodiscard]] std::string trends_to_markdown(const TrendTable& table);

}  // namespace driftlab
