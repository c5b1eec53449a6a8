#include "schema/json/investigation_figures.hpp"

#include "core/analysis/drawn_values.hpp"
#include "core/investigate/unnamed/unnamed_effect.hpp"
#include "schema/figure/axes.hpp"
#include "schema/json/figure_values.hpp"

#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace driftlab {
namespace {

using figure::Figure;
using figure::Mark;
using figure::Plot;
using figure::ScaleKind;
using figure::Series;

constexpr double kHalfHeight = 130.0;  ///< of one of two plots [px]
constexpr double kHeight = 260.0;      ///< of one alone

Series curve(std::string name, std::vector<double> x, Values y) {
  Series one{.name = std::move(name), .x = std::move(x), .y = std::move(y)};
  one.line = true;
  one.width = 1.0;
  return one;
}

Figure figure_of(const std::string& title, std::string sentence, std::vector<Plot> plots) {
  Figure figure{.title = title, .sentence = std::move(sentence), .source = "driftlab " DRIFTLAB_VERSION};
  for (std::size_t i = 0; i + 1 < plots.size(); ++i) {
    plots[i].hide_x = true;
  }
  figure.plots = std::move(plots);
  return figure;
}

Figure allan(const Json& series, const std::string& title, const std::string& unit) {
  const Json& deviation = series.at("allan");
  const std::vector<double> tau = numbers_of(deviation.at("tau_s"));
  Plot plot{.x = {ScaleKind::Log, "averaging time τ, s"}, .y = {ScaleKind::Log, "Allan deviation, " + unit}};
  Series measured{.name = "measured", .x = tau, .y = values_of(deviation.at("measured")), .mark = Mark::Dot};
  Series baseline = curve("baseline", tau, values_of(deviation.at("baseline")));
  baseline.colour = figure::palette::kInk3;
  baseline.dash = {6.0, 4.0};
  Series extended = curve("extended", tau, values_of(deviation.at("extended")));
  extended.colour = figure::palette::kModel;
  extended.width = 2.0;
  plot.series = {std::move(measured), std::move(extended), std::move(baseline)};
  plot.height = kHeight;
  return figure_of(title + ": Allan deviation",
                   "Allan deviation as measured, as the baseline has it, and with what was found.", {std::move(plot)});
}

Figure spectrum(const Json& series, const std::string& title) {
  const Json& density = series.at("spectrum");
  const std::vector<double> frequency = numbers_of(density.at("f_hz"));
  const Values base = values_of(density.at("baseline").at("median"));
  std::vector<Plot> plots;
  for (const auto& [mean, highest, name] :
       {std::tuple{"measured", "highest", "before: measured ÷ baseline"},
        std::tuple{"remaining", "highest_remaining", "after: remaining ÷ baseline"}}) {
    Series density_curve = curve("mean", frequency, over(values_of(density.at(mean)), base));
    density_curve.low = over(values_of(density.at("baseline").at("q025")), base);
    density_curve.high = over(values_of(density.at("baseline").at("q975")), base);
    density_curve.band = figure::palette::kModelBand;
    Series peaks = curve("highest of each bin", frequency, over(values_of(density.at(highest)), base));
    peaks.colour = figure::palette::kRobust;
    Series chance = curve("chance, 1 in 20", frequency, over(values_of(density.at("chance")), base));
    chance.colour = figure::palette::kInk3;
    chance.dash = {4.0, 3.0};
    Plot plot{.x = {ScaleKind::Linear, "frequency, Hz"}, .y = {ScaleKind::Log, name}};
    plot.series = {std::move(density_curve), std::move(peaks), std::move(chance)};
    for (Series& one : plot.series) {
      one.key = plots.empty();
    }
    plot.height = kHalfHeight;
    plot.rules = {1.0};
    plots.push_back(std::move(plot));
  }
  return figure_of(title + ": spectrum",
                   "Two-sided density over the baseline, mean and highest of each bin, before and after the findings.",
                   std::move(plots));
}

Figure wavelets(const Json& series, const std::string& title) {
  const Json& wavelet = series.at("wavelet");
  std::vector<Plot> plots;
  for (const auto& [member, of, name] : {std::tuple{"measured", "baseline", "before: deviation ÷ simulated"},
                                         std::tuple{"remaining", "extended", "after: remaining ÷ simulated"}}) {
    const Json& band = wavelet.at(of);
    const Values median = values_of(band.at("median"));
    Series simulated = curve("simulated, 95 %", numbers_of(wavelet.at("scale_s")), over(median, median));
    simulated.low = over(values_of(band.at("q025")), median);
    simulated.high = over(values_of(band.at("q975")), median);
    simulated.band = figure::palette::kModelBand;
    simulated.colour = figure::palette::kModel;
    Series measured{
        .name = "measured", .x = simulated.x, .y = over(values_of(wavelet.at(member)), median), .mark = Mark::Dot};
    Plot plot{.x = {ScaleKind::Log, "scale, s"}};
    plot.series = {std::move(simulated), std::move(measured)};
    plot.y = figure::ratio_axis(name, reach_of_ratios(plot.series.back().y, 1.1, 2.0));
    for (Series& one : plot.series) {
      one.key = plots.empty();
    }
    plot.height = kHalfHeight;
    plot.rules = {1.0};
    plots.push_back(std::move(plot));
  }
  return figure_of(
      title + ": wavelet deviation",
      "Haar wavelet deviation over the simulated median with the simulated 95 % band, before and after the findings.",
      std::move(plots));
}

Figure course(const Json& series, const std::string& title, const std::string& unit) {
  const Json& means = series.at("course");
  const std::vector<double> time = numbers_of(means.at("time_s"));
  Series error{.name = "error", .x = time, .y = values_of(means.at("error")), .mark = Mark::Dot};
  Series effect = curve("found effect", time, values_of(means.at("effect")));
  effect.colour = figure::palette::kModel;
  effect.width = 2.0;
  Plot plot{.x = {ScaleKind::Linear, "time, s"}, .y = {ScaleKind::Linear, "error, " + unit}};
  plot.series = {std::move(effect), std::move(error)};
  plot.height = kHeight;
  return figure_of(title + ": time course of " + series.at("recording").get<std::string>(),
                   "Means of the error over time in one recording, and the effect that was found.", {std::move(plot)});
}

/// The innovations of the recording whose noise changes most.
Figure spectrogram(const Json& series, const std::string& title) {
  const Json& picture = series.at("spectrogram");
  Plot plot{.x = {ScaleKind::Linear, "time, s"}, .y = {ScaleKind::Log, "frequency, Hz"}};
  plot.cells = {numbers_of(picture.at("time_s")), numbers_of(picture.at("f_hz")), {}};
  for (const Json& row : picture.at("log10_ratio")) {
    for (const std::optional<double> value : values_of(row)) {
      plot.cells.values.push_back(value.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  }
  for (const auto& [name, colour] :
       {std::pair{"more than expected", figure::palette::kRobust}, std::pair{"less", figure::palette::kModel}}) {
    Series key = curve(name, {}, {});
    key.colour = colour;
    key.width = 6.0;
    plot.series.push_back(std::move(key));
  }
  if (!plot.cells.x.empty() && !plot.cells.y.empty()) {
    plot.x.domain = {plot.cells.x.front(), plot.cells.x.back()};
    plot.y.domain = {plot.cells.y.front(), plot.cells.y.back()};
  }
  plot.height = kHeight;
  return figure_of(title + ": spectrogram of the innovations of " + picture.at("recording").get<std::string>(),
                   "Density of what the extended model leaves over that of white noise, by time and frequency; full "
                   "colour is ten times more or less.",
                   {std::move(plot)});
}

/// A profile that the extended model holds without a name.
Figure profile(const Json& found, const std::string& name) {
  const auto kind = found.at("kind").get<std::string>();
  const bool mean = kind == "mean";
  Series bins{.name = "measured", .x = numbers_of(found.at("middles")), .y = values_of(found.at("values"))};
  bins.low = values_of(found.at("q025"));
  bins.high = values_of(found.at("q975"));
  bins.mark = Mark::Dot;
  const auto against = found.at("against").get<std::string>();
  const auto known = investigate::unnamed_against(against);
  Plot plot{.x = {against == "frequency" ? ScaleKind::Log : ScaleKind::Linear,
                  (known ? std::string(words_of(*known)) : against) + ", " +
                      printed_unit(found.at("along").get<std::string>())}};
  plot.y = {ScaleKind::Linear, mean                 ? "mean, " + printed_unit(found.value("unit", ""))
                               : kind == "variance" ? "power of the noise ÷ model"
                                                    : "density ÷ model"};
  plot.rules = {mean ? 0.0 : 1.0};
  plot.series = {std::move(bins)};
  plot.height = kHeight;
  return figure_of(name + ": without a name", found.at("explanation").get<std::string>() + ".", {std::move(plot)});
}

}  // namespace

std::vector<NamedFigure> figures_of_investigation(const Json& document, const std::string& channel) {
  std::vector<NamedFigure> figures;
  for (const Json& series : document.value("figures", Json::array())) {
    const auto name = series.at("channel").get<std::string>();
    if (!is_asked_for(name, channel)) {
      continue;
    }
    const std::string unit = printed_unit(series.value("unit", ""));
    figures.push_back({word(name + "-allan"), allan(series, name, unit), name});
    figures.push_back({word(name + "-spectrum"), spectrum(series, name), name});
    figures.push_back({word(name + "-wavelet"), wavelets(series, name), name});
    figures.push_back({word(name + "-course"), course(series, name, unit), name});
    if (series.contains("spectrogram")) {
      figures.push_back({word(name + "-spectrogram"), spectrogram(series, name), name});
    }
  }
  for (const Json& found : document.value("unnamed", Json::array())) {
    const auto name = found.at("channel").get<std::string>();
    if (is_asked_for(name, channel)) {
      figures.push_back(
          {word(name + "-" + found.at("kind").get<std::string>() + "-" + found.at("against").get<std::string>() + "-" +
                (found.contains("recordings") ? found.at("recordings").at(0).get<std::string>() : "all")),
           profile(found, name), name});
    }
  }
  return figures;
}

}  // namespace driftlab
