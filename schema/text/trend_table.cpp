#include "schema/text/trend_table.hpp"

#include <array>
#include <cstdio>

namespace driftlab {
namespace {

std::string tests_of(const Trend& trend) {
  std::array<char, 96> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), " (trend p = %.2g, equal p = %.2g). ",
                                   trend.monotone_p, trend.equal_p);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

std::string line_of(const ColumnTrend& column) {
  const Trend& trend = column.trend;
  const char* const arrow = trend.direction > 0 ? " ↑" : trend.direction < 0 ? " ↓" : "";
  const char* const motion = column.against == Dynamics::Rate ? "rate" : "angular acceleration";
  const std::string unit = column.column.unit.empty() ? "" : " " + column.column.unit;
  return column.column.key + arrow + " against |" + motion + "|: " + formula(trend.relation) + unit + ", w in " +
         std::string(unit_of(column.against)) + tests_of(trend) + statement(trend) + "\n";
}

}  // namespace

std::string trends_to_text(const TrendTable& table) {
  std::string text;
  for (const ColumnTrend& column : table.trends) {
    text += line_of(column);
  }
  return text.empty() ? "No parameter is known under two conditions of one kind of motion.\n" : text;
}

}  // namespace driftlab
