#include "schema/figure/ratio_panels.hpp"

#include "schema/figure/svg_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace driftlab::figure {
namespace {

template <class... Arguments>
std::string written(const char* format, Arguments... arguments) {
  std::array<char, 512> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, arguments...);
  return {buffer.data(), std::min(static_cast<std::size_t>(length), buffer.size() - 1)};
}

constexpr double kPanelWide = 300.0;
constexpr double kPanelHigh = 150.0;
constexpr double kPanelLeft = 46.0;
constexpr double kPanelTop = 26.0;
constexpr double kPlotWide = 240.0;
constexpr double kPlotHigh = 96.0;

/// Of one panel: log tau from left to right, ln ratio from bottom to top.
struct PanelAxes {
  double low_tau = 0.01;
  double high_tau = 1.0;
  double reach = 0.2;  ///< largest |ln ratio| shown

  [[nodiscard]] double x(double tau_s) const {
    return kPanelLeft + kPlotWide * std::log(tau_s / low_tau) / std::max(std::log(high_tau / low_tau), 1e-9);
  }
  [[nodiscard]] double y(double ln_ratio) const {
    return kPanelTop + 0.5 * kPlotHigh * (1.0 - std::clamp(ln_ratio / reach, -1.0, 1.0));
  }
};

std::string panel_svg(const RatioPanel& panel, double scope_s) {
  const std::vector<RatioPoint>& points = panel.points;
  std::string svg =
      written("<text x=\"%.0f\" y=\"16\" font-weight=\"bold\">", kPanelLeft) + escaped(panel.name) + "</text>\n";
  if (points.size() < 2) {
    return svg;
  }
  PanelAxes axes{points.front().tau_s, points.back().tau_s, 0.0};
  for (const RatioPoint& point : points) {
    const double margin = point.tau_s <= scope_s ? point.margin : 0.0;
    const double shown = point.tau_s <= scope_s ? std::max(point.high, -point.low) : 0.0;
    axes.reach = std::max({axes.reach, 1.3 * margin, 1.1 * std::min(shown, 1.5), std::abs(point.ln_ratio)});
  }
  if (scope_s >= axes.low_tau) {
    svg += written("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"#eef2f6\"/>\n", kPanelLeft,
                   kPanelTop, std::min(axes.x(scope_s), kPanelLeft + kPlotWide) - kPanelLeft, kPlotHigh);
  }
  std::string band;
  std::string line;
  std::string margin;
  for (const RatioPoint& point : points) {
    band += written("%.1f,%.1f ", axes.x(point.tau_s), axes.y(point.high));
    line += written("%.1f,%.1f ", axes.x(point.tau_s), axes.y(point.ln_ratio));
    margin += written("%.1f,%.1f ", axes.x(point.tau_s), axes.y(point.margin));
  }
  for (auto point = points.rbegin(); point != points.rend(); ++point) {
    band += written("%.1f,%.1f ", axes.x(point->tau_s), axes.y(point->low));
  }
  svg += "<polygon points=\"" + band + "\" fill=\"#4477aa\" fill-opacity=\"0.25\"/>\n";
  svg += written("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#888\"/>\n", kPanelLeft, axes.y(0.0),
                 kPanelLeft + kPlotWide, axes.y(0.0));
  svg += "<polyline points=\"" + margin + "\" fill=\"none\" stroke=\"#aa3333\" stroke-dasharray=\"5 3\"/>\n";
  svg += "<polyline points=\"" + line + "\" fill=\"none\" stroke=\"#224466\" stroke-width=\"1.5\"/>\n";
  for (const RatioPoint& point : points) {
    const double x = axes.x(point.tau_s);
    const double y = axes.y(point.ln_ratio);
    svg += point.crossed ? written("<path d=\"M%.1f %.1fl8 8m0 -8l-8 8\" stroke=\"#aa3333\" stroke-width=\"2\"/>\n",
                                   x - 4.0, y - 4.0)
                         : written("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2\" fill=\"#224466\"/>\n", x, y);
  }
  for (const double at : {-axes.reach, 0.0, axes.reach}) {
    svg += written("<text x=\"%.0f\" y=\"%.1f\" text-anchor=\"end\">%+.0f %%</text>\n", kPanelLeft - 4.0,
                   axes.y(at) + 4.0, 100.0 * std::expm1(at));
  }
  for (const std::size_t end : {0U, 1U}) {
    svg += written("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">",
                   axes.x(end == 0 ? axes.low_tau : axes.high_tau), kPanelTop + kPlotHigh + 15.0) +
           panel.end_words[end] + "</text>\n";
  }
  return svg;
}

/// Width of a text of 11 px in a common sans-serif face, generously.
double badge_width(const std::string& text) { return 6.6 * static_cast<double>(text.size()) + 12.0; }

}  // namespace

std::string to_svg(const RatioPanels& figure) {
  const std::size_t columns = std::min<std::size_t>(3, std::max<std::size_t>(1, figure.panels.size()));
  const std::size_t lines = (figure.panels.size() + columns - 1) / columns;
  const double wide = kPanelWide * static_cast<double>(columns);
  const double high = kPanelHigh * static_cast<double>(lines) + 26.0;
  std::string svg = written(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 "
      "%.0f %.0f\" font-family=\"sans-serif\" font-size=\"11\" role=\"img\">\n",
      wide, high, wide, high);
  svg += "<title>" + escaped(figure.title) + "</title>\n";
  svg += written("<rect width=\"%.0f\" height=\"%.0f\" fill=\"#ffffff\"/>\n", wide, high);
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    const std::size_t row = p / columns;
    svg += written("<g transform=\"translate(%.0f %.0f)\">\n", kPanelWide * static_cast<double>(p % columns),
                   kPanelHigh * static_cast<double>(row)) +
           panel_svg(figure.panels[p], figure.scope_s) + "</g>\n";
  }
  svg += written("<text x=\"%.0f\" y=\"%.0f\">", 8.0, high - 8.0) + escaped(figure.caption) + "</text>\n</svg>\n";
  return svg;
}

std::string badge_svg(const std::string& left, const std::string& right, const std::string& colour) {
  const double a = badge_width(left);
  const double b = badge_width(right);
  std::string svg = written(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"20\" role=\"img\" "
      "font-family=\"sans-serif\" font-size=\"11\" fill=\"#ffffff\">\n",
      a + b);
  svg += "<title>" + escaped(left) + ": " + escaped(right) + "</title>\n";
  svg += written("<rect width=\"%.0f\" height=\"20\" fill=\"#3c4043\"/>\n", a);
  svg += written("<rect x=\"%.0f\" width=\"%.0f\" height=\"20\" fill=\"%s\"/>\n", a, b, colour.c_str());
  svg += "<text x=\"6\" y=\"14\">" + escaped(left) + "</text>\n";
  svg += written("<text x=\"%.0f\" y=\"14\">", a + 6.0) + escaped(right) + "</text>\n</svg>\n";
  return svg;
}

}  // namespace driftlab::figure
