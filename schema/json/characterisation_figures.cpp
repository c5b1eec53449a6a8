#include "schema/json/characterisation_figures.hpp"

#include "core/analysis/drawn_allan.hpp"
#include "core/fit/characterise.hpp"
#include "schema/figure/axes.hpp"
#include "schema/figure/layout.hpp"
#include "schema/json/figure_values.hpp"
#include "schema/json/reported_channel.hpp"
#include "schema/json/stored_channel.hpp"

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

Series robust_series(const StoredChannel& channel, const DrawnCurve& curve) {
  const std::size_t disjoint = channel.contamination ? channel.contamination->disjoint_scales.size() : 0;
  Series series = series_of("robust", curve);
  series.detail = disjoint > 0 ? std::to_string(disjoint) + " of " + std::to_string(channel.told.haar.scale.size()) +
                                     " scales differ"
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
};

ComponentStyle style_of(const std::string& process, int nth) {
  static const std::map<std::string, ComponentStyle> styles{{"white_noise", {"#00785a", {7.0, 4.0}}},
                                                            {"gauss_markov", {"#6b2a86", {2.0, 3.5}}},
                                                            {"random_walk", {"#5c4300", {10.0, 3.0, 2.0, 3.0}}},
                                                            {"linear_drift", {"#5d6670", {4.0, 4.0}}},
                                                            {"quantization_noise", {"#5d6670", {1.0, 1.0}}}};
  if (process == "gauss_markov" && nth == 1) {
    return {"#a63a63", {1.0, 3.0}};
  }
  const auto found = styles.find(process);
  return found != styles.end() ? found->second : ComponentStyle{"#5d6670", {4.0, 4.0}};
}

/// The processes of the model, each by itself; none of a model of one.
std::vector<Series> component_series(const DrawnAllan& drawn) {
  std::vector<Series> components;
  if (!drawn.model || drawn.model->components.size() < 2) {
    return components;
  }
  std::map<std::string, int> seen;
  for (const auto& [process, curve] : drawn.model->components) {
    const int nth = seen[process]++;
    const ComponentStyle style = style_of(process, nth);
    Series series = series_of(process_name(process) + (nth > 0 ? " " + std::to_string(nth + 1) : ""), curve);
    series.colour = style.colour;
    series.dash = style.dash;
    components.push_back(std::move(series));
  }
  return components;
}

/// N at 1 s, K at 3 s, B as a line at 0.664 B; each only where the data identify it.
std::vector<Note> notes_of(const DrawnAllan& drawn, const std::vector<Series>& components) {
  std::vector<Note> notes;
  for (const DrawnLevel& level : drawn.levels) {
    notes.push_back({level.place.tau_s, level.place.deviation, level.name + " = " + quantity_text(to_json(level.value)),
                     "read at τ = " + figure::tick_text(level.place.tau_s) + " s", components[level.component].colour,
                     false});
  }
  if (drawn.bias) {
    notes.push_back({drawn.classical.x.back(), drawn.bias->deviation,
                     "B = " + quantity_text(to_json(drawn.bias->value)), "line at 0.664 B", figure::palette::kInk,
                     true});
  }
  return notes;
}

/// Measured over model, on a scale on which misfit shows.
Plot ratio_plot(const DrawnAllan& drawn, const Series& classical, const std::optional<Series>& robust) {
  const DrawnRatios ratios = ratios_of(drawn);
  const auto relative = [](const Series& shown, const DrawnCurve& ratio) {
    Series one = series_of(shown.name + " ÷ model", ratio);
    one.mark = shown.mark;
    one.colour = shown.colour;
    one.line = false;
    one.key = false;
    return one;
  };
  Plot plot{.x = {ScaleKind::Log, "averaging time τ, s"}, .series = {relative(classical, ratios.classical)}};
  plot.y = figure::ratio_axis("measured ÷ model", ratios.end);
  plot.y.ticks = figure::ratio_ticks(ratios.end);
  plot.height = 96.0;
  plot.rules = {1.0};
  if (robust && ratios.robust) {
    plot.series.push_back(relative(*robust, *ratios.robust));
  }
  return plot;
}

}  // namespace

Figure allan_figure(const StoredChannel& channel, const std::string& recording) {
  const ReportedFit* const fit = channel.best_fit();
  const DrawnAllan drawn = drawn_allan(channel);
  const Series classical = classical_series(drawn.classical);
  const std::optional<Series> robust =
      drawn.robust ? std::optional(robust_series(channel, *drawn.robust)) : std::nullopt;
  std::vector<Series> components = component_series(drawn);
  Figure figure{
      .title = recording + ", " + channel.told.channel + ": Allan deviation",
      .sentence = "Allan deviation against averaging time, log-log with equal decades, points with 95 % intervals" +
                  (fit != nullptr ? ", fitted model " + fit->model + "." : std::string(".")),
      .source = "driftlab " DRIFTLAB_VERSION ", " + recording + ", algorithm " + std::to_string(kAlgorithmVersion)};
  Plot main{.x = {ScaleKind::Log, drawn.model ? "" : "averaging time τ, s"},
            .y = {ScaleKind::Log, "Allan deviation, " + printed_unit(drawn.unit.symbol)},
            .series = {classical}};
  main.equal_units = true;
  main.guides = {{-1.0, "−1"}, {-0.5, "−½"}, {0.0, "0"}, {0.5, "+½"}, {1.0, "+1"}};
  main.notes = notes_of(drawn, components);
  if (robust) {
    main.series.push_back(*robust);
  }
  if (drawn.model) {
    Series model = series_of(fit->model, drawn.model->whole);
    model.detail = fit->robust ? "fitted to robust" : "fitted";
    model.colour = figure::palette::kModel;
    model.width = 2.0;
    main.series.push_back(std::move(model));
  }
  main.series.insert(main.series.end(), components.begin(), components.end());
  figure.plots.push_back(std::move(main));
  if (drawn.model) {
    figure.plots.push_back(ratio_plot(drawn, classical, robust));
  }
  return figure;
}

std::vector<NamedFigure> figures_of_characterisation(const Json& document, const std::string& channel) {
  std::vector<NamedFigure> figures;
  const bool several = document.at("recordings").size() > 1;
  for (const Json& recording : document.at("recordings")) {
    const auto id = recording.at("id").get<std::string>();
    for (const StoredChannel& one : stored_channels_from_json(recording.at("channels"))) {
      const std::string& name = one.told.channel;
      if (is_asked_for(name, channel) && !one.allan.tau_s.empty()) {
        std::string of_all = id;
        of_all.append("-").append(name);
        figures.push_back({word(several ? of_all : name), allan_figure(one, id), name});
      }
    }
  }
  return figures;
}

}  // namespace driftlab
