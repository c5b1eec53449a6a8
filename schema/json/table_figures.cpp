#include "schema/json/table_figures.hpp"

#include "core/analysis/drawn_values.hpp"
#include "core/signal/unit.hpp"
#include "schema/figure/axes.hpp"
#include "schema/json/figure_values.hpp"
#include "schema/json/stored_member.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace driftlab {

using figure::Figure;
using figure::Mark;
using figure::Plot;
using figure::Series;

namespace {

/// The dynamics that conditions of one kind differ by, in the unit of the first of them.
struct Dynamics {
  std::string kind;  ///< empty: none of the conditions has a size
  std::string unit;
};

/// One for each kind of condition that has a size, in the order of the rows.
std::vector<Dynamics> dynamics_of(const Json& rows) {
  std::vector<Dynamics> found;
  for (const Json& row : rows) {
    const Json& condition = row.at("condition");
    const std::string kind = condition.value("kind", "");
    const bool known = std::any_of(found.begin(), found.end(), [&](const Dynamics& one) { return one.kind == kind; });
    if (condition.contains("unit") && !known) {
      found.push_back({kind, condition.value("unit", "")});
    }
  }
  if (found.empty()) {
    found.emplace_back();
  }
  return found;
}

/// Where a row stands among those of one kind; nothing where it is of another. At rest is zero of every kind.
std::optional<double> place_of(const Json& condition, const Dynamics& dynamics) {
  const auto size = size_of_dynamics(value_of(condition.value("value", Json(nullptr))));
  if (!condition.contains("unit")) {
    return size;
  }
  const auto own = parse_unit(condition.value("unit", ""));
  const auto shown = parse_unit(dynamics.unit);
  if (condition.value("kind", "") != dynamics.kind) {
    return std::nullopt;
  }
  return own && shown && own->dimension == shown->dimension ? shown->from_si(own->to_si(size)) : size;
}

figure::Axis axis_of(const Dynamics& dynamics, const Series& series) {
  const double far = figure::farthest_of(series);
  if (dynamics.kind.empty() || !(far > 0.0)) {
    return {figure::ScaleKind::Linear, "at rest", std::pair{-1.0, 1.0}, {}, true};
  }
  return figure::axis_about_zero("|" + replaced(dynamics.kind, "_", " ") + "|, " + printed_unit(dynamics.unit), far);
}

}  // namespace

std::vector<NamedFigure> figures_of_table(const Json& document, const std::string& parameter) {
  std::vector<NamedFigure> figures;
  const std::string title = document.value("device", "") + ", " + document.value("sensor", "") + " " +
                            (document.at("axis").is_string() ? document.at("axis").get<std::string>() : "");
  const std::string by = method_of_table(document);
  const std::vector<Dynamics> kinds = dynamics_of(document.at("rows"));
  for (const Json& column : document.at("columns")) {
    const auto key = column.at("key").get<std::string>();
    if (!parameter.empty() && key != parameter) {
      continue;
    }
    const std::string name = column_name(key);
    for (const Dynamics& dynamics : kinds) {
      Series series{.name = name};
      for (const Json& row : document.at("rows")) {
        const Json cell = row.at("values").value(key, Json(nullptr));
        const auto place = place_of(row.at("condition"), dynamics);
        if (!place || !cell.is_object() || !cell.value("value", Json(nullptr)).is_number()) {
          continue;
        }
        series.x.push_back(*place);
        series.y.push_back(value_of(cell.at("value")));
        const Json ci95 = cell.value("ci95", Json::array({nullptr, nullptr}));
        series.low.push_back(ci95.is_array() ? value_of(ci95[0]) : std::nullopt);
        series.high.push_back(ci95.is_array() ? value_of(ci95[1]) : std::nullopt);
      }
      if (series.x.empty()) {
        continue;
      }
      const double most = figure::greatest_of(series);
      series.mark = Mark::Dot;
      series.key = false;
      figure::Axis x = axis_of(dynamics, series);
      Plot plot{.x = std::move(x),
                .y = figure::axis_from_zero(name + ", " + printed_unit(text_member(column, "unit")), most),
                .series = {std::move(series)}};
      std::string named = title;
      named.append(": ").append(name);
      Figure figure{.title = std::move(named),
                    .sentence = name + " under each condition with its 95 % interval, from zero.",
                    .source = "driftlab " DRIFTLAB_VERSION + (by.empty() ? "" : ", " + by)};
      figure.plots.push_back(std::move(plot));
      figures.push_back({kinds.size() > 1 ? word(key + "-" + dynamics.kind) : word(key), std::move(figure), key});
    }
  }
  return figures;
}

std::string method_of_table(const Json& table) {
  const std::string model = text_member(table, "model");
  return model.empty() && text_member(table, "method") == "av" ? "Allan variance" : model;
}

std::vector<NamedFigure> figures_of_tables(const Json& document, const std::string& parameter) {
  std::set<std::string> sensors;
  for (const Json& table : document.at("tables")) {
    sensors.insert(text_member(table, "sensor"));
  }
  std::vector<NamedFigure> figures;
  for (const Json& table : document.at("tables")) {
    const std::string of_sensor = sensors.size() > 1 ? text_member(table, "sensor") + "-" : "";
    const std::string axis = of_sensor + text_member(table, "axis");
    for (NamedFigure& figure : figures_of_table(table, parameter)) {
      figures.push_back({axis.empty() ? figure.name : word(axis + "-" + figure.name), std::move(figure.figure),
                         std::move(figure.subject)});
    }
  }
  return figures;
}

}  // namespace driftlab
