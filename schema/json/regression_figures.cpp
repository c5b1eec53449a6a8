#include "schema/json/regression_figures.hpp"

#include "schema/json/figure_values.hpp"

#include <algorithm>
#include <cmath>
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
    double far = std::log(1.2);
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
      for (const auto& value : {change.y.back(), change.low.back(), change.high.back(), margin.y.back()}) {
        far = value && *value > 0.0 ? std::max(far, std::abs(std::log(*value))) : far;
      }
    }
    if (change.x.empty()) {
      continue;
    }
    change.mark = Mark::Dot;
    margin.line = true;
    margin.colour = figure::palette::kRobust;
    margin.dash = {5.0, 3.0};
    const double limit = std::exp(1.1 * far);
    Plot plot{.x = {ScaleKind::Log, "averaging time τ, s"},
              .y = {ScaleKind::Log, "candidate ÷ baseline", std::pair{1.0 / limit, limit}}};
    plot.y.ticks = limit > 2.2   ? std::vector{0.5, 1.0, 2.0}
                   : limit > 1.6 ? std::vector{0.67, 1.0, 1.5}
                                 : std::vector{0.8, 0.9, 1.0, 1.1, 1.25};
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
