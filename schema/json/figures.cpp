#include "schema/json/figures.hpp"

#include "core/fit/characterise.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/unit.hpp"
#include "core/signal/with_count.hpp"
#include "schema/json/channel_summary.hpp"
#include "schema/json/figure_values.hpp"
#include "schema/json/investigation_figures.hpp"
#include "schema/json/regression_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace driftlab {
namespace {

using figure::Axis;
using figure::Figure;
using figure::Mark;
using figure::Note;
using figure::Plot;
using figure::ScaleKind;
using figure::Series;

Values roots(Values values, double factor) {
  for (auto& value : values) {
    value = value && *value >= 0.0 ? std::optional(std::sqrt(*value) * factor) : std::nullopt;
  }
  return values;
}

/// The unit in which a channel's deviations are drawn, and its size in units of the channel: that of the parameters.
std::pair<std::string, double> drawn_unit(const std::string& channel_unit) {
  const auto unit = parse_unit(channel_unit);
  if (!unit || (unit->dimension != Dimension::AngularRate && unit->dimension != Dimension::SpecificForce)) {
    return {channel_unit, 1.0};
  }
  const auto wanted = parse_unit(unit->dimension == Dimension::AngularRate ? "deg/h" : "mg");
  return {wanted->symbol, unit->factor / wanted->factor};
}

struct ComponentStyle {
  const char* colour;
  std::vector<double> dash;
  const char* name;
};

ComponentStyle style_of(const std::string& process, int nth) {
  static const std::map<std::string, ComponentStyle> styles{
      {"white_noise", {"#00785a", {7.0, 4.0}, "white noise"}},
      {"gauss_markov", {"#6b2a86", {2.0, 3.5}, "Gauss-Markov"}},
      {"random_walk", {"#5c4300", {10.0, 3.0, 2.0, 3.0}, "random walk"}},
      {"linear_drift", {"#5d6670", {4.0, 4.0}, "drift"}},
      {"quantization_noise", {"#5d6670", {1.0, 1.0}, "quantization"}}};
  if (process == "gauss_markov" && nth == 1) {
    return {"#a63a63", {1.0, 3.0}, "Gauss-Markov"};
  }
  const auto found = styles.find(process);
  return found != styles.end() ? found->second : ComponentStyle{"#5d6670", {4.0, 4.0}, ""};
}

Series measured_series(const Json& channel, double factor) {
  const Json& allan = channel.at("allan");
  Series series{.name = "classical",
                .detail = "95 % interval",
                .x = numbers_of(allan.at("tau_s")),
                .y = values_of(allan.at("deviation"), factor)};
  series.low = ends_of(allan.at("ci95"), 0, factor);
  series.high = ends_of(allan.at("ci95"), 1, factor);
  series.mark = Mark::Dot;
  series.line = true;
  series.band = figure::palette::kBand;
  series.width = 0.8;
  return series;
}

/// The robust estimate where one scale differs from the classical; Allan variance is twice the wavelet variance.
std::optional<Series> robust_series(const Json& channel, double factor) {
  const Json& haar = channel.at("haar");
  const std::size_t disjoint = channel.at("contamination").at("disjoint_scales").size();
  const bool shown = haar.contains("robust") && haar["robust"].is_object() &&
                     (disjoint > 0 || channel.at("contamination").value("verdict", "") == "contaminated");
  if (!shown) {
    return std::nullopt;
  }
  const double scaled = factor * std::sqrt(2.0);
  const Json& robust = haar["robust"];
  Series series{.name = "robust",
                .detail = disjoint > 0 ? std::to_string(disjoint) + " of " + std::to_string(haar.at("scale").size()) +
                                             " scales differ"
                                       : "agrees"};
  for (const Json& scale : haar.at("scale")) {
    series.x.push_back(scale.get<double>() / 2.0 * channel.at("dt_s").get<double>());
  }
  series.y = roots(values_of(robust.at("variance")), scaled);
  series.low = roots(ends_of(robust.at("ci95"), 0), scaled);
  series.high = roots(ends_of(robust.at("ci95"), 1), scaled);
  series.mark = Mark::Diamond;
  series.line = true;
  series.colour = figure::palette::kRobust;
  series.band = figure::palette::kRobustBand;
  series.width = 1.2;
  return series;
}

Series line_series(std::string name, const Json& tau, const Json& deviation, double factor) {
  Series series{.name = std::move(name), .x = numbers_of(tau), .y = values_of(deviation, factor)};
  series.line = true;
  return series;
}

std::vector<Series> component_series(const Json& allan, double factor) {
  std::vector<Series> components;
  std::map<std::string, int> seen;
  for (const Json& component : allan.at("components")) {
    const auto process = component.at("process").get<std::string>();
    const int nth = seen[process]++;
    const ComponentStyle style = style_of(process, nth);
    const std::string name = *style.name != '\0' ? style.name : replaced(process, "_", " ");
    Series series = line_series(name + (nth > 0 ? " " + std::to_string(nth + 1) : ""), allan.at("tau_s"),
                                component.at("deviation"), factor);
    series.colour = style.colour;
    series.dash = style.dash;
    components.push_back(std::move(series));
  }
  return components;
}

/// The value of a curve at x, between its points on both logarithms.
std::optional<double> curve_at(const Series& series, double x) {
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const std::optional<double> here = series.y[i];
    if (series.x[i] < x * (1.0 - 1e-9) || !here) {
      continue;
    }
    if (std::abs(series.x[i] - x) <= 1e-9 * x) {
      return here;
    }
    const std::optional<double> before = i > 0 ? series.y[i - 1] : std::nullopt;
    if (!before) {
      return std::nullopt;
    }
    const double share = std::log(x / series.x[i - 1]) / std::log(series.x[i] / series.x[i - 1]);
    return std::exp(std::log(*before) + std::log(*here / *before) * share);
  }
  return std::nullopt;
}

/// N at 1 s, K at 3 s, B as a line at 0.664 B; each only where the data identify it.
std::vector<Note> notes_of(const Json& channel, const Json& fit, const std::vector<Series>& components, double factor) {
  std::vector<Note> notes;
  const std::vector<double> tau = numbers_of(channel.at("allan").at("tau_s"));
  for (std::size_t i = 0; fit.is_object() && i < fit.at("processes").size() && i < components.size(); ++i) {
    const Json& process = fit.at("processes")[i];
    const auto name = process.at("process").get<std::string>();
    const double at = name == "white_noise" ? 1.0 : name == "random_walk" ? 3.0 : 0.0;
    if (at < tau.front() || at > tau.back() || at == 0.0 || process.at("params").empty()) {
      continue;
    }
    const auto level = process.at("params").items().begin();
    const auto y = curve_at(components[i], at);
    if (level.value().is_object() && level.value().at("value").is_number() && y) {
      notes.push_back({at, *y, level.key() + " = " + quantity_text(level.value()),
                       std::string("read at τ = ") + (at == 1.0 ? "1" : "3") + " s", components[i].colour, false});
    }
  }
  const Json bias = channel.at("allan_parameters").value("B", Json(nullptr));
  const auto unit = parse_unit(channel.at("unit").get<std::string>());
  if (bias.is_object() && bias.value("value", Json(nullptr)).is_number() && unit && unit->dimension != Dimension::One) {
    const double per_si = lab_unit(unit->dimension, 0).per_si;
    const double level = bias.at("value").get<double>() / per_si / unit->factor * factor * 0.664;
    notes.push_back({tau.back(), level, "B = " + quantity_text(bias), "line at 0.664 B", figure::palette::kInk, true});
  }
  return notes;
}

/// Measured over model, on a scale on which misfit shows.
Plot ratio_plot(const Series& measured, const std::optional<Series>& robust, const Json& implied, double factor) {
  const Series curve = line_series("", implied.at("allan").at("tau_s"), implied.at("allan").at("deviation"), factor);
  std::map<double, double> exact;
  const Json& ratio = implied.at("ratio");
  for (std::size_t i = 0; i < ratio.at("tau_s").size(); ++i) {
    if (const auto value = value_of(ratio.at("deviation")[i])) {
      exact[ratio.at("tau_s")[i].get<double>()] = *value * factor;
    }
  }
  const auto relative = [&](const Series& series) {
    Values model;
    for (const double x : series.x) {
      const auto found = exact.find(x);
      model.push_back(found != exact.end() ? std::optional(found->second) : curve_at(curve, x));
    }
    Series one{.name = series.name + " ÷ model",
               .x = series.x,
               .y = over(series.y, model),
               .low = over(series.low, model),
               .high = over(series.high, model),
               .mark = series.mark,
               .colour = series.colour};
    one.key = false;
    return one;
  };
  Plot plot{.x = {ScaleKind::Log, "averaging time τ, s"},
            .y = {ScaleKind::Log, "measured ÷ model"},
            .series = {relative(measured)}};
  double far = 0.25;
  for (const auto& value : plot.series.front().y) {
    far = value ? std::max(far, std::abs(std::log(*value))) : far;
  }
  const double limit = std::min(std::exp(far * 1.25), 8.0);
  plot.y.domain = {1.0 / limit, limit};
  plot.y.ticks = limit > 2.2   ? std::vector{0.5, 1.0, 2.0}
                 : limit > 1.6 ? std::vector{0.67, 1.0, 1.5}
                               : std::vector{0.8, 1.0, 1.25};
  plot.height = 96.0;
  plot.rules = {1.0};
  if (robust) {
    plot.series.push_back(relative(*robust));
  }
  return plot;
}

std::vector<NamedFigure> of_characterisation(const Json& document, const std::string& channel) {
  std::vector<NamedFigure> figures;
  const bool several = document.at("recordings").size() > 1;
  for (const Json& recording : document.at("recordings")) {
    const auto id = recording.at("id").get<std::string>();
    for (const Json& one : recording.at("channels")) {
      const auto name = one.at("channel").get<std::string>();
      if ((channel.empty() || name == channel) && !one.at("allan").at("tau_s").empty()) {
        std::string of_all = id;
        of_all.append("-").append(name);
        figures.push_back({word(several ? of_all : name), allan_figure(one, id)});
      }
    }
  }
  return figures;
}

std::vector<NamedFigure> of_outages(const Json& document) {
  static constexpr std::array<const char*, 6> kColours{"#16191d", "#0067a8", "#c04a00",
                                                       "#00785a", "#6b2a86", "#5c4300"};
  Plot plot{
      .x = {ScaleKind::Linear, "outage"}, .y = {ScaleKind::Log, "mean horizontal error at its end, m"}, .series = {}};
  plot.height = 300.0;
  std::size_t index = 0;
  const double count = static_cast<double>(std::max<std::size_t>(1, document.at("filters").size()));
  for (const Json& filter : document.at("filters")) {
    Series series{.name = filter.at("name").get<std::string>(), .detail = quantity_text(filter.at("mean_error_m"))};
    for (const Json& outage : filter.at("outages")) {
      // Side by side: what belongs to one outage stands within half a step of it.
      series.x.push_back(outage.at("index").get<double>() +
                         (static_cast<double>(index) / count - 0.5 + 0.5 / count) * 0.5);
      const Json& error = outage.at("error_m");
      series.y.push_back(value_of(error.at("value")));
      const Json ci95 = error.value("ci95", Json::array({nullptr, nullptr}));
      series.low.push_back(value_of(ci95[0]));
      series.high.push_back(value_of(ci95[1]));
    }
    plot.x.domain = {0.4, static_cast<double>(series.x.size()) + 0.6};
    plot.x.ticks.clear();
    for (std::size_t i = 1; i <= series.x.size(); ++i) {
      plot.x.ticks.push_back(static_cast<double>(i));
    }
    series.mark = index % 2 == 0 ? Mark::Dot : Mark::Diamond;
    series.colour = kColours[index % kColours.size()];
    ++index;
    plot.series.push_back(std::move(series));
  }
  Figure figure{
      .title = "Errors at the ends of the outages",
      .sentence = "Mean horizontal error of each filter at the end of each outage with its 95 % interval.",
      .source = "driftlab " DRIFTLAB_VERSION ", " + with_count(document.value("runs", std::size_t{0}), "run")};
  figure.plots.push_back(std::move(plot));
  return {{"outages", std::move(figure)}};
}

/// Rows by the size of their rate or acceleration; 0 at rest.
double dynamics_of(const Json& condition) {
  const auto value = value_of(condition.value("value", Json(nullptr)));
  return value ? std::abs(*value) : 0.0;
}

std::vector<NamedFigure> of_table(const Json& document, const std::string& parameter) {
  std::vector<NamedFigure> figures;
  const std::string title = document.value("device", "") + ", " + document.value("sensor", "") + " " +
                            (document.at("axis").is_string() ? document.at("axis").get<std::string>() : "");
  for (const Json& column : document.at("columns")) {
    const auto key = column.at("key").get<std::string>();
    Series series{.name = key};
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
      series.x.push_back(dynamics_of(condition));
      series.y.push_back(value_of(cell.at("value")));
      const Json ci95 = cell.value("ci95", Json::array({nullptr, nullptr}));
      series.low.push_back(ci95.is_array() ? value_of(ci95[0]) : std::nullopt);
      series.high.push_back(ci95.is_array() ? value_of(ci95[1]) : std::nullopt);
    }
    if ((!parameter.empty() && key != parameter) || series.x.empty()) {
      continue;
    }
    double most = 0.0;
    for (std::size_t i = 0; i < series.y.size(); ++i) {
      most = std::max({most, series.y[i].value_or(0.0), series.high[i].value_or(0.0)});
    }
    const double far = std::max(1e-9, *std::max_element(series.x.begin(), series.x.end()));
    series.mark = Mark::Dot;
    series.key = false;
    Plot plot{.x = {ScaleKind::Linear, replaced(against, "_", " "), std::pair{-far * 0.04, far * 1.06}},
              .y = {ScaleKind::Linear, key + ", " + printed_unit(unit), std::pair{0.0, most * 1.12}},
              .series = {std::move(series)}};
    std::string named = title;
    named.append(": ").append(key);
    Figure figure{.title = std::move(named),
                  .sentence = key + " under each condition with its 95 % interval, from zero.",
                  .source = "driftlab " DRIFTLAB_VERSION ", " + document.value("model", std::string())};
    figure.plots.push_back(std::move(plot));
    figures.push_back({word(key), std::move(figure)});
  }
  return figures;
}

}  // namespace

Figure allan_figure(const Json& channel, const std::string& recording) {
  const auto [unit, factor] = drawn_unit(channel.at("unit").get<std::string>());
  const Json& fits = channel.at("fits");
  const Json fit = fits.empty()
                       ? Json(nullptr)
                       : fits[channel.value("best", Json(0)).is_number() ? channel["best"].get<std::size_t>() : 0];
  const Json implied = fit.is_object() ? implied_by(fit, channel) : Json(nullptr);
  Series measured = measured_series(channel, factor);
  std::optional<Series> robust = robust_series(channel, factor);
  std::vector<Series> components = implied.is_object() && implied.at("allan").at("components").size() > 1
                                       ? component_series(implied.at("allan"), factor)
                                       : std::vector<Series>{};
  const auto name = channel.at("channel").get<std::string>();
  Figure figure{
      .title = recording + ", " + name + ": Allan deviation",
      .sentence = "Allan deviation against averaging time, log-log with equal decades, points with 95 % intervals" +
                  (fit.is_object() ? ", fitted model " + fit.at("model").get<std::string>() + "." : std::string(".")),
      .source = "driftlab " DRIFTLAB_VERSION ", " + recording + ", algorithm " + std::to_string(kAlgorithmVersion)};
  Plot main{.x = {ScaleKind::Log, implied.is_object() ? "" : "averaging time τ, s"},
            .y = {ScaleKind::Log, "Allan deviation, " + printed_unit(unit)},
            .series = {measured}};
  main.equal_decades = true;
  main.guides = {{-1.0, "−1"}, {-0.5, "−½"}, {0.5, "+½"}};
  main.notes = notes_of(channel, fit, components, factor);
  if (robust) {
    main.series.push_back(*robust);
  }
  if (implied.is_object()) {
    Series model = line_series(fit.at("model").get<std::string>(), implied.at("allan").at("tau_s"),
                               implied.at("allan").at("deviation"), factor);
    model.detail = fit.value("robust", false) ? "fitted to robust" : "fitted";
    model.colour = figure::palette::kModel;
    model.width = 2.0;
    main.series.push_back(std::move(model));
  }
  main.series.insert(main.series.end(), components.begin(), components.end());
  figure.plots.push_back(std::move(main));
  if (implied.is_object()) {
    figure.plots.push_back(ratio_plot(measured, robust, implied, factor));
  }
  return figure;
}

Result<std::vector<NamedFigure>> figures_of(const Json& document, const std::string& channel) {
  try {
    std::vector<NamedFigure> figures;
    if (document.contains("recordings") && document["recordings"].is_array()) {
      figures = of_characterisation(document, channel);
    } else if (document.contains("units") && document.contains("verdict")) {
      figures = figures_of_regression(document, channel);
    } else if (document.contains("findings")) {
      figures = figures_of_investigation(document, channel);
    } else if (document.contains("filters") && document.contains("runs")) {
      figures = of_outages(document);
    } else if (document.contains("columns") && document.contains("rows")) {
      figures = of_table(document, channel);
    } else {
      return fail(ErrorCode::InvalidArgument,
                  "This is no document with a figure: a characterisation, an investigation, an outage evaluation, a "
                  "regression run or a "
                  "parameter "
                  "table, as --json writes them.");
    }
    if (figures.empty()) {
      return fail(ErrorCode::InvalidArgument, channel.empty()
                                                  ? "The document has nothing to draw: no curve with a point."
                                                  : "The document has no figure of '" + channel + "'.");
    }
    return figures;
  } catch (const Json::exception& error) {
    return fail(ErrorCode::Internal, std::string("The document is not as driftlab writes it: ") + error.what());
  }
}

}  // namespace driftlab
