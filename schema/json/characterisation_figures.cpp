#include "schema/json/characterisation_figures.hpp"

#include "core/analysis/drawn_values.hpp"
#include "core/fit/characterise.hpp"
#include "core/signal/unit.hpp"
#include "schema/figure/axes.hpp"
#include "schema/figure/layout.hpp"
#include "schema/json/channel_summary.hpp"
#include "schema/json/figure_values.hpp"
#include "schema/json/reported_channel.hpp"

#include <map>
#include <optional>
#include <utility>

namespace driftlab {
namespace {

using figure::Figure;
using figure::Mark;
using figure::Note;
using figure::Plot;
using figure::ScaleKind;
using figure::Series;

/// What a fit implies, in the unit drawn.
struct DrawnModel {
  DrawnCurve whole;
  DrawnCurve at_measured;
  std::vector<std::pair<std::string, DrawnCurve>> components;  ///< by process
};

/// What the document says of a channel, in the unit drawn.
struct DrawnChannel {
  DrawnUnit unit;
  DrawnCurve classical;
  std::optional<DrawnCurve> robust;  ///< where one scale differs from the classical
  std::optional<DrawnModel> model;   ///< of the best fit
};

DrawnCurve curve_of(const std::vector<double>& x, const std::vector<double>& y, double factor) {
  return scaled(DrawnCurve{x, Values(y.begin(), y.end()), {}, {}}, factor);
}

DrawnModel drawn(const ImpliedBeside& implied, double factor) {
  const ImpliedCurves& curves = implied.curves;
  DrawnModel model{curve_of(curves.tau_s, curves.deviation, factor),
                   curve_of(implied.at_measured.tau_s, implied.at_measured.deviation, factor),
                   {}};
  for (const ImpliedComponent& component : curves.components) {
    model.components.emplace_back(component.process, curve_of(curves.tau_s, component.deviation, factor));
  }
  return model;
}

std::optional<DrawnCurve> robust_of(const Json& channel, double factor) {
  const Json& haar = channel.at("haar");
  const auto contamination = contamination_from_json(channel);
  if (!contamination || !robust_differs(*contamination) || !haar.contains("robust") || !haar["robust"].is_object()) {
    return std::nullopt;
  }
  const Json& robust = haar["robust"];
  return deviations_of_wavelets(
      haar.at("scale").get<std::vector<std::size_t>>(), channel.at("dt_s").get<double>(), factor,
      DrawnCurve{{}, values_of(robust.at("variance")), ends_of(robust.at("ci95"), 0), ends_of(robust.at("ci95"), 1)});
}

/// The best fit, or null.
Json best_fit(const Json& channel) {
  const Json& fits = channel.at("fits");
  if (fits.empty()) {
    return nullptr;
  }
  return fits[channel.value("best", Json(0)).is_number() ? channel["best"].get<std::size_t>() : 0];
}

DrawnChannel drawn(const Json& channel, const Json& fit) {
  DrawnChannel told;
  told.unit = drawn_unit(channel.at("unit").get<std::string>());
  const MeasuredDeviation measured = deviation_from_json(channel.at("allan"));
  told.classical =
      scaled(DrawnCurve{measured.tau_s, measured.deviation, measured.low, measured.high}, told.unit.factor);
  told.robust = robust_of(channel, told.unit.factor);
  if (const auto implied = fit.is_object() ? implied_from_json(fit, channel) : std::nullopt) {
    told.model = drawn(*implied, told.unit.factor);
  }
  return told;
}

Series series_of(std::string name, DrawnCurve curve) {
  Series series{.name = std::move(name), .x = std::move(curve.x), .y = std::move(curve.y)};
  series.low = std::move(curve.low);
  series.high = std::move(curve.high);
  series.line = true;
  return series;
}

Series classical_series(const DrawnCurve& curve) {
  Series series = series_of("classical", curve);
  series.detail = "95 % interval";
  series.mark = Mark::Dot;
  series.band = figure::palette::kBand;
  series.width = 0.8;
  return series;
}

Series robust_series(const Json& channel, const DrawnCurve& curve) {
  const std::size_t disjoint = channel.at("contamination").at("disjoint_scales").size();
  Series series = series_of("robust", curve);
  series.detail = disjoint > 0 ? std::to_string(disjoint) + " of " +
                                     std::to_string(channel.at("haar").at("scale").size()) + " scales differ"
                               : "agrees";
  series.mark = Mark::Diamond;
  series.colour = figure::palette::kRobust;
  series.band = figure::palette::kRobustBand;
  series.width = 1.2;
  return series;
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

/// The processes of the model, each by itself; none of a model of one.
std::vector<Series> component_series(const DrawnChannel& channel) {
  std::vector<Series> components;
  if (!channel.model || channel.model->components.size() < 2) {
    return components;
  }
  std::map<std::string, int> seen;
  for (const auto& [process, curve] : channel.model->components) {
    const int nth = seen[process]++;
    const ComponentStyle style = style_of(process, nth);
    const std::string name = *style.name != '\0' ? style.name : replaced(process, "_", " ");
    Series series = series_of(name + (nth > 0 ? " " + std::to_string(nth + 1) : ""), curve);
    series.colour = style.colour;
    series.dash = style.dash;
    components.push_back(std::move(series));
  }
  return components;
}

/// N at 1 s, K at 3 s, B as a line at 0.664 B; each only where the data identify it.
std::vector<Note> notes_of(const Json& channel, const Json& fit, const DrawnChannel& drawn,
                           const std::vector<Series>& components) {
  std::vector<Note> notes;
  const std::vector<double>& tau = drawn.classical.x;
  for (std::size_t i = 0; fit.is_object() && i < fit.at("processes").size() && i < components.size(); ++i) {
    const Json& process = fit.at("processes")[i];
    const auto place = level_place(process.at("process").get<std::string>(),
                                   DrawnCurve{components[i].x, components[i].y, {}, {}}, tau);
    if (!place || process.at("params").empty()) {
      continue;
    }
    const auto level = process.at("params").items().begin();
    if (level.value().is_object() && level.value().at("value").is_number()) {
      notes.push_back({place->tau_s, place->deviation, level.key() + " = " + quantity_text(level.value()),
                       "read at τ = " + figure::tick_text(place->tau_s) + " s", components[i].colour, false});
    }
  }
  const Json bias = channel.at("allan_parameters").value("B", Json(nullptr));
  const auto unit = parse_unit(channel.at("unit").get<std::string>());
  if (bias.is_object() && bias.value("value", Json(nullptr)).is_number() && unit && unit->dimension != Dimension::One) {
    notes.push_back({tau.back(), bias_floor(bias.at("value").get<double>(), *unit, drawn.unit),
                     "B = " + quantity_text(bias), "line at 0.664 B", figure::palette::kInk, true});
  }
  return notes;
}

/// Measured over model, on a scale on which misfit shows.
Plot ratio_plot(const DrawnModel& model, const Series& classical, const std::optional<Series>& robust) {
  const auto relative = [&](const Series& shown) {
    Series one = series_of(shown.name + " ÷ model", relative_to(DrawnCurve{shown.x, shown.y, shown.low, shown.high},
                                                                model.at_measured, model.whole));
    one.mark = shown.mark;
    one.colour = shown.colour;
    one.line = false;
    one.key = false;
    return one;
  };
  Plot plot{.x = {ScaleKind::Log, "averaging time τ, s"}, .series = {relative(classical)}};
  const double limit = end_of_ratios(farthest_log(plot.series.front().y, 0.25), 1.25, 8.0);
  plot.y = figure::ratio_axis("measured ÷ model", limit);
  plot.y.ticks = figure::ratio_ticks(limit);
  plot.height = 96.0;
  plot.rules = {1.0};
  if (robust) {
    plot.series.push_back(relative(*robust));
  }
  return plot;
}

}  // namespace

Figure allan_figure(const Json& channel, const std::string& recording) {
  const Json fit = best_fit(channel);
  const DrawnChannel told = drawn(channel, fit);
  const Series classical = classical_series(told.classical);
  const std::optional<Series> robust = told.robust ? std::optional(robust_series(channel, *told.robust)) : std::nullopt;
  std::vector<Series> components = component_series(told);
  const auto name = channel.at("channel").get<std::string>();
  Figure figure{
      .title = recording + ", " + name + ": Allan deviation",
      .sentence = "Allan deviation against averaging time, log-log with equal decades, points with 95 % intervals" +
                  (fit.is_object() ? ", fitted model " + fit.at("model").get<std::string>() + "." : std::string(".")),
      .source = "driftlab " DRIFTLAB_VERSION ", " + recording + ", algorithm " + std::to_string(kAlgorithmVersion)};
  Plot main{.x = {ScaleKind::Log, told.model ? "" : "averaging time τ, s"},
            .y = {ScaleKind::Log, "Allan deviation, " + printed_unit(told.unit.symbol)},
            .series = {classical}};
  main.equal_units = true;
  main.guides = {{-1.0, "−1"}, {-0.5, "−½"}, {0.5, "+½"}};
  main.notes = notes_of(channel, fit, told, components);
  if (robust) {
    main.series.push_back(*robust);
  }
  if (told.model) {
    Series model = series_of(fit.at("model").get<std::string>(), told.model->whole);
    model.detail = fit.value("robust", false) ? "fitted to robust" : "fitted";
    model.colour = figure::palette::kModel;
    model.width = 2.0;
    main.series.push_back(std::move(model));
  }
  main.series.insert(main.series.end(), components.begin(), components.end());
  figure.plots.push_back(std::move(main));
  if (told.model) {
    figure.plots.push_back(ratio_plot(*told.model, classical, robust));
  }
  return figure;
}

std::vector<NamedFigure> figures_of_characterisation(const Json& document, const std::string& channel) {
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

}  // namespace driftlab
