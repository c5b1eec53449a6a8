#include "schema/text/trend_table.hpp"

#include "schema/text/fields.hpp"

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

constexpr std::array kTrendHeading{"parameter", "against", "direction", "relation", "unit",
                                   "w in",      "trend p", "equal p",   "statement"};

std::array<std::string, kTrendHeading.size()> fields_of(const ColumnTrend& column) {
  const Trend& trend = column.trend;
  const auto written = [](double p) {
    std::array<char, 32> buffer{};
    (void)std::snprintf(buffer.data(), buffer.size(), "%.2g", p);
    return std::string(buffer.data());
  };
  return {column.column.key,
          column.against == Dynamics::Rate ? "rate" : "angular acceleration",
          trend.direction > 0   ? "up"
          : trend.direction < 0 ? "down"
                                : "none",
          formula(trend.relation),
          column.column.unit,
          std::string(unit_of(column.against)),
          written(trend.monotone_p),
          written(trend.equal_p),
          statement(trend)};
}

}  // namespace

std::string trends_to_csv(const TrendTable& table) {
  std::string text;
  for (std::size_t i = 0; i < kTrendHeading.size(); ++i) {
    text += std::string(i == 0 ? "" : ",") + kTrendHeading[i];
  }
  text += "\r\n";
  for (const ColumnTrend& column : table.trends) {
    const auto fields = fields_of(column);
    for (std::size_t i = 0; i < fields.size(); ++i) {
      text += (i == 0 ? "" : ",") + csv_field(fields[i]);
    }
    text += "\r\n";
  }
  return text;
}

std::string trends_to_markdown(const TrendTable& table) {
  std::string text = "|";
  std::string rule = "|";
  for (const char* const name : kTrendHeading) {
    text += std::string(" ") + name + " |";
    rule += " --- |";
  }
  text += "\n" + rule + "\n";
  for (const ColumnTrend& column : table.trends) {
    text += "|";
    for (const std::string& field : fields_of(column)) {
      text += " " + markdown_field(field) + " |";
    }
    text += "\n";
  }
  return text;
}

std::string trends_to_text(const TrendTable& table) {
  std::string text;
  for (const ColumnTrend& column : table.trends) {
    text += line_of(column);
  }
  return text.empty() ? "No parameter is known under two conditions of one kind of motion.\n" : text;
}

}  // namespace driftlab
