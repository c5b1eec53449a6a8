#include "schema/json/table_figures.hpp"

#include "core/analysis/drawn_values.hpp"
#include "schema/figure/axes.hpp"
#include "schema/json/figure_values.hpp"

#include <utility>

namespace driftlab {

using figure::Figure;
using figure::Mark;
using figure::Plot;
using figure::Series;

std::vector<NamedFigure> figures_of_table(const Json& document, const std::string& parameter) {
  std::vector<NamedFigure> figures;
  const std::string title = document.value("device", "") + ", " + document.value("sensor", "") + " " +
                            (document.at("axis").is_string() ? document.at("axis").get<std::string>() : "");
  for (const Json& column : document.at("columns")) {
    const auto key = column.at("key").get<std::string>();
    const std::string name = column_name(key);
    Series series{.name = name};
    const std::string unit = column.value("unit", "");
    std::string against = "condition";
    for (const Json& row : document.at("rows")) {
      const Json cell = row.at("values").value(key, Json(nullptr));
      const Json& condition = row.at("condition");
      against = condition.contains("unit")
                    ? "|" + condition.value("kind", "") + "|, " + printed_unit(condition.value("unit", ""))
                    : against;
      if (!cell.is_object() || !cell.value("value", Json(nullptr)).is_number()) {
        continue;
      }
      series.x.push_back(size_of_dynamics(value_of(condition.value("value", Json(nullptr)))));
      series.y.push_back(value_of(cell.at("value")));
      const Json ci95 = cell.value("ci95", Json::array({nullptr, nullptr}));
      series.low.push_back(ci95.is_array() ? value_of(ci95[0]) : std::nullopt);
      series.high.push_back(ci95.is_array() ? value_of(ci95[1]) : std::nullopt);
    }
    if ((!parameter.empty() && key != parameter) || series.x.empty()) {
      continue;
    }
    const double most = figure::greatest_of(series);
    const double far = figure::farthest_of(series);
    series.mark = Mark::Dot;
    series.key = false;
    Plot plot{.x = figure::axis_about_zero(replaced(against, "_", " "), far),
              .y = figure::axis_from_zero(name + ", " + printed_unit(unit), most),
              .series = {std::move(series)}};
    std::string named = title;
    named.append(": ").append(name);
    Figure figure{.title = std::move(named),
                  .sentence = name + " under each condition with its 95 % interval, from zero.",
                  .source = "driftlab " DRIFTLAB_VERSION ", " + document.value("model", std::string())};
    figure.plots.push_back(std::move(plot));
    figures.push_back({word(key), std::move(figure)});
  }
  return figures;
}

}  // namespace driftlab
