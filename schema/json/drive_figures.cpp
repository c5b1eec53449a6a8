#include "schema/json/drive_figures.hpp"

#include "core/navigate/drive/outage_map.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/with_count.hpp"
#include "schema/figure/layout.hpp"
#include "schema/json/figure_values.hpp"

#include <algorithm>
#include <array>
#include <limits>
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

/// All curves, not those with marks alone, and a simulation far below them too.
void frame_errors(Plot& plot) {
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const Series& series : plot.series) {
    for (const auto& y : series.y) {
      if (y && *y > 0.0) {
        least = std::min(least, *y);
        most = std::max(most, *y);
      }
    }
  }
  if (most > 0.0) {
    plot.y.domain = {least / 1.5, most * 1.5};
  }
}

NamedFigure growth_figure(const Json& document, const Json& duration, std::vector<Series> series,
                          std::string sentence) {
  Plot plot{.x = {ScaleKind::Log, "time without fixes, s"}, .y = {ScaleKind::Log, "horizontal error, m"}};
  plot.height = 300.0;
  plot.series = std::move(series);
  frame_errors(plot);
  Figure figure{.title = "Error in outages of " + seconds(duration.at("duration_s")),
                .sentence = std::move(sentence),
                .source = source_of(document) + ", " + with_count(duration.value("n", std::size_t{0}), "outage")};
  figure.plots.push_back(std::move(plot));
  return {"error-" + short_name(duration.at("duration_s")), std::move(figure)};
}

bool drawn(const Series& series) { return !series.x.empty(); }

using Place = drive::MapPlace;

/// What the map says of one class of outages: how the error compares with what the filter expects.
struct NeesClass {
  const char* name;
  double most;  ///< NEES
  const char* colour;
};
// -2 ln(1 - p): chi-square of two degrees of freedom
constexpr std::array kClasses{NeesClass{"in 50 % ellipse", 1.3863, "#00785a"},
                              NeesClass{"between 50 and 95 %", 5.9915, palette::kModel},
                              NeesClass{"outside", std::numeric_limits<double>::infinity(), palette::kRobust}};

/// What lies outside every class has no NEES, and is drawn as being outside.
std::size_t class_of(const Json& outage) {
  const auto nees = value_of(outage.at("nees"));
  for (std::size_t k = 0; k + 1 < kClasses.size(); ++k) {
    if (nees && *nees <= kClasses[k].most) {
      return k;
    }
  }
  return kClasses.size() - 1;
}

/// Strokes that do not hang together, one after the other.
class Strokes {
 public:
  void add(std::initializer_list<Place> places) { add(std::vector<Place>(places)); }
  void add(const std::vector<Place>& places) {
    for (const Place& place : places) {
      series_.x.push_back(place[0]);
      series_.y.emplace_back(place[1]);
    }
    series_.x.push_back(places.back()[0]);
    series_.y.emplace_back();
  }
  [[nodiscard]] Series take(const char* colour, double width) {
    series_.line = true;
    series_.key = false;
    series_.colour = colour;
    series_.width = width;
    return std::move(series_);
  }

 private:
  Series series_;
};

/// Both axes with one length for a metre: the shorter side is widened, and nothing is drawn outside.
void frame(Plot& plot) {
  std::array<double, 4> ends{1e300, -1e300, 1e300, -1e300};
  for (const Series& series : plot.series) {
    for (std::size_t i = 0; i < series.x.size(); ++i) {
      if (const auto& y = series.y[i]) {
        ends = {std::min(ends[0], series.x[i]), std::max(ends[1], series.x[i]), std::min(ends[2], *y),
                std::max(ends[3], *y)};
      }
    }
  }
  const double margin = 0.04 * std::max({ends[1] - ends[0], ends[3] - ends[2], 1.0});
  double wide = ends[1] - ends[0] + 2.0 * margin;
  double high = ends[3] - ends[2] + 2.0 * margin;
  constexpr double kFlattest = 0.4;
  wide = std::max(wide, high);
  high = std::max(high, kFlattest * wide);
  const double east = 0.5 * (ends[0] + ends[1]);
  const double north = 0.5 * (ends[2] + ends[3]);
  plot.x.domain = {east - 0.5 * wide, east + 0.5 * wide};
  plot.y.domain = {north - 0.5 * high, north + 0.5 * high};
  plot.equal_units = true;
}

NamedFigure map_figure(const Json& document, const Json& duration) {
  std::array<Series, kClasses.size()> ends;
  std::array<Strokes, kClasses.size()> errors;
  std::array<std::size_t, kClasses.size()> counts{};
  double worst = 0.0;
  for (const Json& outage : duration.at("outages")) {
    const std::size_t k = class_of(outage);
    const Place truth{outage.at("map_m").at(1).get<double>(), outage.at("map_m").at(0).get<double>()};
    const Place error{outage.at("east_m").get<double>(), outage.at("north_m").get<double>()};
    const Place believed{truth[0] + error[0], truth[1] + error[1]};
    ends[k].x.push_back(truth[0]);
    ends[k].y.emplace_back(truth[1]);
    errors[k].add({truth, believed});
    const Json& covariance = outage.at("covariance_m2");
    errors[k].add(drive::ellipse95(
        believed, {covariance.at(0).get<double>(), covariance.at(1).get<double>(), covariance.at(2).get<double>()}));
    ++counts[k];
    worst = std::max(worst, drive::horizontal_m(error[1], error[0]));
  }
  Plot plot{.x = {ScaleKind::Linear, "east, m"}, .y = {ScaleKind::Linear, "north, m"}};
  for (std::size_t k = 0; k < kClasses.size(); ++k) {
    if (counts[k] == 0) {
      continue;
    }
    ends[k].name = kClasses[k].name;
    ends[k].detail = with_count(counts[k], "outage");
    ends[k].mark = Mark::Dot;
    ends[k].colour = kClasses[k].colour;
    plot.series.push_back(std::move(ends[k]));
    plot.series.push_back(errors[k].take(kClasses[k].colour, 1.0));
  }
  if (const Json path = document.value("path", Json()); path.is_object()) {
    Series way{.name = "the drive", .x = numbers_of(path.at("east_m")), .y = values_of(path.at("north_m"))};
    way.line = true;
    way.colour = palette::kRule;
    plot.series.push_back(std::move(way));
  }
  frame(plot);
  const std::string time = seconds(duration.at("duration_s"));
  Figure figure{.title = "Where outages of " + time + " ended",
                .sentence = "Of " + with_count(duration.at("outages").size(), "outage") + " of " + time + " " +
                            std::to_string(counts.back()) +
                            " ended outside the filter's 95 % ellipse; the largest error is " + metres(worst) + ".",
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
