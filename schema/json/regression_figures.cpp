#include "schema/json/regression_figures.hpp"

#include "core/analysis/drawn_values.hpp"
#include "core/signal/short_name.hpp"
#include "schema/figure/axes.hpp"
#include "schema/json/figure_values.hpp"

#include <optional>
#include <utility>

namespace driftlab {

using figure::Figure;
using figure::Mark;
using figure::Plot;
using figure::ScaleKind;
using figure::Series;

namespace {

std::string axis_name(const Json& unit) { return unit.value("sensor", "") + " " + unit.value("axis", ""); }

}  // namespace

std::string unit_name(const Json& unit) {
  const Json condition = unit.value("condition", Json(nullptr));
  const std::string name = axis_name(unit);
  return name + (condition.is_string() ? ", " + condition.get<std::string>() : "");
}

namespace {

/// What one arm measured: the baseline as a line with its band, the candidate as points with theirs.
/// `unit`: set to that of the deviations.
Series arm_series(const Json& tests, const char* arm, std::string& unit) {
  Series series{.name = arm};
  for (const Json& test : tests) {
    const auto tau = value_of(test.value("tau_s", Json(nullptr)));
    const Json deviation = test.value(arm, Json(nullptr));
    if (!tau || !deviation.is_object()) {
      continue;  // a parameter, or a run of before arms were told
    }
    unit = deviation.at("unit").get<std::string>();
    series.x.push_back(*tau);
    series.y.push_back(value_of(deviation.at("value")));
    series.low.push_back(value_of(deviation.at("ci95")[0]));
    series.high.push_back(value_of(deviation.at("ci95")[1]));
  }
  return series;
}

/// The deviations of both arms over each other; nothing where the run does not tell them.
std::optional<Plot> arms_plot(const Json& tests) {
  std::string unit;
  Series candidate = arm_series(tests, "candidate", unit);
  Series baseline = arm_series(tests, "baseline", unit);
  if (candidate.x.empty() || baseline.x.empty()) {
    return std::nullopt;
  }
  candidate.mark = Mark::Dot;
  candidate.detail = "95 % interval";
  baseline.line = true;
  baseline.band = figure::palette::kBand;
  Plot plot{.x = {ScaleKind::Log, "averaging time τ, s"}, .y = {ScaleKind::Log, "Allan deviation, " + unit}};
  plot.series = {std::move(candidate), std::move(baseline)};
  figure::frame_by_curves(plot);
  return plot;
}

}  // namespace

std::vector<NamedFigure> figures_of_regression(const Json& document, const std::string& axis) {
  std::vector<NamedFigure> figures;
  for (const Json& unit : document.at("units")) {
    const std::string subject = short_sensor_name(axis_name(unit));
    if (!is_asked_for(unit.value("axis", ""), axis) && axis != subject && axis != axis_name(unit) &&
        axis != unit_name(unit)) {
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
        .sentence =
            "Allan deviation of the candidate over that of the baseline with intervals, and the margin; below, both.",
        .source = "driftlab " DRIFTLAB_VERSION};
    auto arms = arms_plot(unit.at("tests"));
    plot.hide_x = arms.has_value();
    figure.plots.push_back(std::move(plot));  // first, for a terminal draws no more
    if (arms) {
      figure.plots.push_back(std::move(*arms));
    }
    figures.push_back({word(unit_name(unit)), std::move(figure), subject});
  }
  return figures;
}

}  // namespace driftlab
