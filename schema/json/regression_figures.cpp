#include "schema/json/regression_figures.hpp"

#include "core/analysis/drawn_values.hpp"
#include "schema/figure/axes.hpp"
#include "schema/json/figure_values.hpp"

#include <utility>

namespace driftlab {

using figure::Figure;
using figure::Mark;
using figure::Plot;
using figure::ScaleKind;
using figure::Series;

std::string unit_name(const Json& unit) {
  const Json condition = unit.value("condition", Json(nullptr));
  const std::string name = unit.value("sensor", "") + " " + unit.value("axis", "");
  return name + (condition.is_string() ? ", " + condition.get<std::string>() : "");
}

std::vector<NamedFigure> figures_of_regression(const Json& document, const std::string& axis) {
  std::vector<NamedFigure> figures;
  for (const Json& unit : document.at("units")) {
    if (!axis.empty() && unit.value("axis", "") != axis) {
      continue;
    }
    Series change{.name = "change", .detail = "95 %, all at once"};
    Series margin{.name = "margin"};
    for (const Json& test : unit.at("tests")) {
      const auto tau = value_of(test.value("tau_s", Json(nullptr)));
      if (!tau) {
        continue;  // a parameter
      }
      change.x.push_back(*tau);
      change.y.push_back(value_of(test.at("ratio")));
      change.low.push_back(value_of(test.at("ci")[0]));
      change.high.push_back(value_of(test.at("ci")[1]));
      margin.x.push_back(*tau);
      margin.y.push_back(value_of(test.at("margin")));
    }
    if (change.x.empty()) {
      continue;
    }
    change.mark = Mark::Dot;
    margin.line = true;
    margin.colour = figure::palette::kRobust;
    margin.dash = {5.0, 3.0};
    double far = farthest_log({1.2}, 0.0);  // an axis of changes shows 20 % at least
    for (const Values* const values : {&change.y, &change.low, &change.high, &margin.y}) {
      far = farthest_log(*values, far);
    }
    const double limit = end_of_ratios(far, 1.1);
    Plot plot{.x = {ScaleKind::Log, "averaging time τ, s"}, .y = figure::ratio_axis("candidate ÷ baseline", limit)};
    plot.y.ticks = figure::ratio_ticks(limit, true);
    plot.series = {std::move(change), std::move(margin)};
    plot.rules = {1.0};
    Figure figure{
        .title = unit_name(unit) + ": change of the Allan deviation",
        .sentence = "Allan deviation of the candidate over that of the baseline with intervals, and the margin.",
        .source = "driftlab " DRIFTLAB_VERSION};
    figure.plots.push_back(std::move(plot));
    figures.push_back({word(unit_name(unit)), std::move(figure)});
  }
  return figures;
}

}  // namespace driftlab
