#include "core/campaign/trend_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <utility>

namespace driftlab {
namespace {

/// |rate| or |angular acceleration| of a row in degrees; nothing for a row of another kind.
std::optional<double> magnitude(const Condition& condition, Dynamics against) {
  if (condition.kind == ConditionKind::Static) {
    return 0.0;
  }
  const ConditionKind kind =
      against == Dynamics::Rate ? ConditionKind::ConstantRate : ConditionKind::ConstantAngularAcceleration;
  if (condition.kind != kind || !condition.value) {
    return std::nullopt;
  }
  return std::fabs(*condition.value) * 180.0 / std::numbers::pi;
}

std::string figures(const char* format, double a, double b = 0.0, double c = 0.0) {
  std::array<char, 160> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, a, b, c);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

/// The estimate with a closed, positive interval; nothing where it is not known so well.
std::optional<Estimate> closed_estimate(const ReportedValue& cell) {
  if (!cell.value || !cell.low || !cell.high) {
    return std::nullopt;
  }
  const bool usable = *cell.low > 0.0 && *cell.high > *cell.low && *cell.value > 0.0;
  return usable ? std::optional(Estimate{*cell.value, {*cell.low, *cell.high}}) : std::nullopt;
}

/// One column of the rows against one kind of dynamics; nothing where fewer than two rows tell.
template <class CellOf>
std::optional<ColumnTrend> trend_of(const std::vector<TableRow>& rows, TableColumn column, CellOf cell_of,
                                    Dynamics against) {
  ColumnTrend followed;
  followed.column = std::move(column);
  followed.against = against;
  std::vector<TrendPoint> points;
  bool moving = false;
  for (const TableRow& row : rows) {
    const auto at = magnitude(row.condition, against);
    if (!at) {
      continue;
    }
    const ReportedValue& cell = cell_of(row).estimate;
    const auto estimate = closed_estimate(cell);
    if (!estimate) {
      followed.left_out.push_back({row.label, *at, cell.value ? "The interval is open." : cell.reason});
      continue;
    }
    moving = moving || *at > 0.0;
    points.push_back({*at, *estimate});
    followed.points.push_back({row.label, *at, *estimate, row.contamination, row.robust});
  }
  if (!moving) {
    return std::nullopt;
  }
  auto trend = fit_trend(std::move(points));
  if (!trend) {
    return std::nullopt;
  }
  followed.trend = std::move(*trend);
  return followed;
}

/// N, the density at low frequencies; its unit is that of the first row that has one.
TableColumn density_column(const std::vector<TableRow>& rows) {
  const auto known =
      std::find_if(rows.begin(), rows.end(), [](const TableRow& row) { return !row.density.estimate.unit.empty(); });
  return {"N", known == rows.end() ? "" : known->density.estimate.unit};
}

}  // namespace

std::string_view name_of(Dynamics dynamics) { return dynamics == Dynamics::Rate ? "rate" : "angular_acceleration"; }
std::string_view unit_of(Dynamics dynamics) { return dynamics == Dynamics::Rate ? "deg/s" : "deg/s^2"; }

TrendTable build_trends(const ParameterTable& table) {
  TrendTable result{table.device, table.quantity, table.axis, table.method, table.model, {}};
  const auto keep = [&result](std::optional<ColumnTrend> trend) {
    if (trend) {
      result.trends.push_back(std::move(*trend));
    }
  };
  for (const Dynamics against : {Dynamics::Rate, Dynamics::AngularAcceleration}) {
    if (table.method == TableMethod::Gmwm) {  // a column of its own by the other method
      keep(trend_of(
          table.rows, density_column(table.rows), [](const TableRow& row) -> const TableCell& { return row.density; },
          against));
    }
    for (std::size_t column = 0; column < table.columns.size(); ++column) {
      keep(trend_of(
          table.rows, table.columns[column],
          [column](const TableRow& row) -> const TableCell& { return row.cells[column]; }, against));
    }
  }
  return result;
}

std::string formula(const FittedRelation& relation) {
  const double slope = (relation.high - relation.low) / std::pow(relation.scale, relation.exponent);
  switch (relation.relation) {
    case Relation::Constant:
      return figures("%.4g", relation.low);
    case Relation::Linear:
      return figures("%.4g %+.4g w", relation.low, slope);
    case Relation::Power:
      break;
  }
  return figures("%.4g %+.4g w^%.3g", relation.low, slope, relation.exponent);
}

std::string statement(const Trend& trend) {
  if (trend.direction != 0) {
    return trend.direction > 0 ? "Rises with the dynamics." : "Falls with the dynamics.";
  }
  return trend.equal_p < 0.05 ? "Moves with the condition, but not in one direction." : "Does not move.";
}

}  // namespace driftlab
