#include "schema/json/outage_figures.hpp"

#include "core/signal/with_count.hpp"
#include "schema/figure/axes.hpp"
#include "schema/json/figure_values.hpp"

#include <array>
#include <utility>

namespace driftlab {

using figure::Figure;
using figure::Mark;
using figure::Plot;
using figure::ScaleKind;
using figure::Series;

std::vector<NamedFigure> figures_of_outages(const Json& document) {
  static constexpr std::array<const char*, 6> kColours{"#16191d", "#0067a8", "#c04a00",
                                                       "#00785a", "#6b2a86", "#5c4300"};
  Plot plot{.y = {ScaleKind::Log, "mean horizontal error at its end, m"}, .series = {}};
  plot.height = 300.0;
  std::size_t index = 0;
  for (const Json& filter : document.at("filters")) {
    Series series{.name = filter.at("name").get<std::string>(), .detail = quantity_text(filter.at("mean_error_m"))};
    for (const Json& outage : filter.at("outages")) {
      series.x.push_back(figure::beside(outage.at("index").get<double>(), index, document.at("filters").size()));
      const Json& error = outage.at("error_m");
      series.y.push_back(value_of(error.at("value")));
      const Json ci95 = error.value("ci95", Json::array({nullptr, nullptr}));
      series.low.push_back(value_of(ci95[0]));
      series.high.push_back(value_of(ci95[1]));
    }
    plot.x = figure::places_axis("outage", series.x.size());
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

}  // namespace driftlab
