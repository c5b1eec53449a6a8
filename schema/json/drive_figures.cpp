#include "schema/json/drive_figures.hpp"

#include "core/analysis/drawn_drive.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/with_count.hpp"
#include "schema/figure/axes.hpp"
#include "schema/figure/layout.hpp"
#include "schema/json/figure_values.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace driftlab {

using figure::Figure;
using figure::Mark;
using figure::Plot;
using figure::ScaleKind;
using figure::Series;

namespace {

namespace palette = figure::palette;

constexpr std::array<const char*, 6> kFilters{"#16191d", "#0067a8", "#c04a00", "#00785a", "#6b2a86", "#5c4300"};
constexpr const char* kDashed = palette::kInk3;

std::string seconds(const Json& duration) { return figure::tick_text(duration.get<double>()) + " s"; }

/// For a file name: 10s.
std::string short_name(const Json& duration) { return figure::tick_text(duration.get<double>()) + "s"; }

std::string metres(double value) { return significant(value, std::nullopt, std::nullopt) + " m"; }

std::string source_of(const Json& document) {
  return "driftlab " DRIFTLAB_VERSION ", " + document.at("id").get<std::string>();
}

/// The rms against the time in an outage; nothing of a document that was made before it had one.
Series grown(const Json& growth, std::string name) {
  Series series{.name = std::move(name)};
  if (growth.is_object()) {
    series.x = numbers_of(growth.at("time_s"));
    series.y = values_of(growth.at("rms_m"));
  }
  return series;
}

Series measured_growth(const Json& duration, std::string name, const char* colour, Mark mark) {
  Series series = grown(duration.value("growth", Json()), std::move(name));
  series.mark = mark;
  series.line = true;
  series.width = 0.8;
  series.colour = colour;
  return series;
}

/// The middle 90 % of the simulated outages as a band, the rms as a line.
Series simulated_growth(const Json& simulated, std::string detail) {
  const Json growth = simulated.value("growth", Json());
  Series series = grown(growth, "simulated, rms");
  if (growth.is_object()) {
    series.low = values_of(growth.at("p05_m"));
    series.high = values_of(growth.at("p95_m"));
  }
  series.detail = std::move(detail);
  series.line = true;
  series.width = 2.0;
  series.colour = palette::kModel;
  series.band = palette::kModelBand;
  return series;
}

Series median_growth(const Json& duration) {
  const Json growth = duration.value("growth", Json());
  Series series{.name = "median"};
  if (growth.is_object()) {
    series.x = numbers_of(growth.at("time_s"));
    series.y = values_of(growth.at("median_m"));
  }
  series.line = true;
  series.dash = {4.0, 4.0};
  series.colour = palette::kInk2;
  return series;
}

/// The entry of one duration in a list, or nullptr.
const Json* of_duration(const Json& list, const Json& duration_s) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Json& entry) { return entry.at("duration_s") == duration_s; });
  return found == list.end() ? nullptr : &*found;
}

NamedFigure growth_figure(const Json& document, const Json& duration, std::vector<Series> series,
                          std::string sentence) {
  Plot plot{.x = {ScaleKind::Log, "time without fixes, s"}, .y = {ScaleKind::Log, "horizontal error, m"}};
  plot.height = 300.0;
  plot.series = std::move(series);
  figure::frame_by_curves(plot);
  Figure figure{.title = "Error in outages of " + seconds(duration.at("duration_s")),
                .sentence = std::move(sentence),
                .source = source_of(document) + ", " + with_count(duration.value("n", std::size_t{0}), "outage")};
  figure.plots.push_back(std::move(plot));
  return {"error-" + short_name(duration.at("duration_s")), std::move(figure)};
}

bool drawn(const Series& series) { return !series.x.empty(); }

/// How the map calls and colours the classes of outages, by drive::EllipseClass.
struct ClassStyle {
  const char* name;
  const char* colour;
};
constexpr std::array<ClassStyle, drive::kEllipseClasses> kClasses{
    {{"in 50 % ellipse", "#00785a"}, {"between 50 and 95 %", palette::kModel}, {"outside", palette::kRobust}}};

drive::MappedOutage mapped_from_json(const Json& outage) {
  const Json& covariance = outage.at("covariance_m2");
  return {
      .truth_m = {outage.at("map_m").at(1).get<double>(), outage.at("map_m").at(0).get<double>()},
      .error_m = {outage.at("east_m").get<double>(), outage.at("north_m").get<double>()},
      .covariance_m2 = {covariance.at(0).get<double>(), covariance.at(1).get<double>(), covariance.at(2).get<double>()},
      .nees = value_of(outage.at("nees"))};
}

Series ends_of(const drive::MapClass& outages, const ClassStyle& style) {
  Series series{.name = style.name, .detail = with_count(outages.truths_m.size(), "outage")};
  for (const drive::MapPlace& truth : outages.truths_m) {
    series.x.push_back(truth[0]);
    series.y.emplace_back(truth[1]);
  }
  series.mark = Mark::Dot;
  series.colour = style.colour;
  return series;
}

/// Strokes that do not hang together, one after the other.
Series strokes_of(const drive::MapClass& outages, const ClassStyle& style) {
  Series series;
  for (const std::vector<drive::MapPlace>& stroke : outages.strokes_m) {
    for (const drive::MapPlace& place : stroke) {
      series.x.push_back(place[0]);
      series.y.emplace_back(place[1]);
    }
    series.x.push_back(stroke.back()[0]);
    series.y.emplace_back();
  }
  series.line = true;
  series.key = false;
  series.colour = style.colour;
  series.width = 1.0;
  return series;
}

NamedFigure map_figure(const Json& document, const Json& duration) {
  std::vector<drive::MappedOutage> outages;
  for (const Json& outage : duration.at("outages")) {
    outages.push_back(mapped_from_json(outage));
  }
  const drive::OutageMap map = drive::map_of(outages);
  Plot plot{.x = {ScaleKind::Linear, "east, m"}, .y = {ScaleKind::Linear, "north, m"}};
  for (std::size_t k = 0; k < kClasses.size(); ++k) {
    if (!map.classes[k].truths_m.empty()) {
      plot.series.push_back(ends_of(map.classes[k], kClasses[k]));
      plot.series.push_back(strokes_of(map.classes[k], kClasses[k]));
    }
  }
  if (const Json path = document.value("path", Json()); path.is_object()) {
    Series way{.name = "the drive", .x = numbers_of(path.at("east_m")), .y = values_of(path.at("north_m"))};
    way.line = true;
    way.colour = palette::kRule;
    plot.series.push_back(std::move(way));
  }
  figure::frame_as_map(plot);
  const std::string time = seconds(duration.at("duration_s"));
  Figure figure{.title = "Where outages of " + time + " ended",
                .sentence = "Of " + with_count(outages.size(), "outage") + " of " + time + " " +
                            std::to_string(map.of(drive::EllipseClass::Outside).truths_m.size()) +
                            " ended outside the filter's 95 % ellipse; the largest error is " +
                            metres(map.largest_error_m) + ".",
                .source = source_of(document)};
  figure.plots.push_back(std::move(plot));
  return {"map-" + short_name(duration.at("duration_s")), std::move(figure)};
}

std::string end_of(const Json& duration) {
  const auto rms = value_of(duration.at("rms_m").at("value"));
  return rms ? metres(*rms) : "no value";
}

std::vector<NamedFigure> figures_of_comparison(const Json& document) {
  std::vector<NamedFigure> figures;
  const Json& filters = document.at("filters");
  for (const Json& duration : filters.at(0).at("durations")) {
    std::vector<Series> series;
    std::string sentence = "rms error at the end of outages of " + seconds(duration.at("duration_s")) + ":";
    for (const Json& filter : filters) {
      if (const Json* const own = of_duration(filter.at("durations"), duration.at("duration_s"))) {
        const std::size_t i = series.size();
        series.push_back(measured_growth(*own, filter.at("name").get<std::string>(), kFilters[i % kFilters.size()],
                                         i % 2 == 0 ? Mark::Dot : Mark::Diamond));
        sentence += (i == 0 ? " " : ", ") + series.back().name + " " + end_of(*own);
      }
    }
    if (std::any_of(series.begin(), series.end(), drawn)) {
      figures.push_back(growth_figure(document, duration, std::move(series), sentence + "."));
    }
  }
  return figures;
}

std::vector<NamedFigure> figures_of_explanation(const Json& document) {
  std::vector<NamedFigure> figures;
  const Json& before = document.at("before").at("durations");
  for (const Json& duration : document.at("after").at("durations")) {
    const Json& length = duration.at("duration_s");
    std::vector<Series> series{measured_growth(duration, "mended", palette::kInk, Mark::Dot)};
    std::string sentence = "In outages of " + seconds(length) + " the rms error of the mended model is " +
                           end_of(duration) + " at the end";
    if (const Json* const was = of_duration(before, length)) {
      series.push_back(measured_growth(*was, "as it was", palette::kRobust, Mark::Open));
      sentence += ", " + end_of(*was) + " before";
    }
    if (const Json* const simulated = of_duration(document.at("after").at("simulated"), length)) {
      series.push_back(simulated_growth(*simulated, "mended, 90 %"));
    }
    if (const Json* const simulated = of_duration(document.at("before").at("simulated"), length)) {
      Series was = grown(simulated->value("growth", Json()), "simulated, rms");
      was.detail = "as it was";
      was.line = true;
      was.dash = {2.0, 3.5};
      was.colour = kDashed;
      series.push_back(std::move(was));
    }
    if (drawn(series.front())) {
      figures.push_back(growth_figure(document, duration, std::move(series), sentence + "."));
    }
    figures.push_back(map_figure(document, duration));
  }
  return figures;
}

std::vector<NamedFigure> figures_of_measured(const Json& document) {
  std::vector<NamedFigure> figures;
  const Json simulations = document.value("simulated", Json::array());
  for (const Json& duration : document.at("durations")) {
    std::vector<Series> series{measured_growth(duration, "measured, rms", palette::kInk, Mark::Dot)};
    std::string sentence =
        "In outages of " + seconds(duration.at("duration_s")) + " the rms error is " + end_of(duration) + " at the end";
    if (const Json* const simulated = of_duration(simulations, duration.at("duration_s"))) {
      series.push_back(simulated_growth(*simulated, "middle 90 %"));
      sentence += ", simulated " + metres(simulated->at("rms_m").get<double>());
    }
    if (drawn(series.front())) {
      series.push_back(median_growth(duration));
      figures.push_back(growth_figure(document, duration, std::move(series), sentence + "."));
    }
    figures.push_back(map_figure(document, duration));
  }
  return figures;
}

}  // namespace

bool is_drive_evaluation(const Json& document) {
  return document.contains("vehicle") &&
         (document.contains("durations") || document.contains("after") || document.contains("verdicts"));
}

std::vector<NamedFigure> figures_of_drive(const Json& document) {
  if (document.contains("filters")) {
    return figures_of_comparison(document);
  }
  return document.contains("after") ? figures_of_explanation(document) : figures_of_measured(document);
}

}  // namespace driftlab
