/// Figure and badge of a regression run, as SVG without scripts or outside references.
#include "core/signal/with_count.hpp"
#include "schema/text/regression.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace driftlab {
namespace {

using regression::ScaleReport;
using regression::UnitReport;

template <class... Arguments>
std::string svg_written(const char* format, Arguments... arguments) {
  std::array<char, 512> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, arguments...);
  return {buffer.data(), std::min(static_cast<std::size_t>(length), buffer.size() - 1)};
}

std::string svg_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return out;
}

constexpr double kPanelWide = 300.0;
constexpr double kPanelHigh = 150.0;
constexpr double kPanelLeft = 46.0;
constexpr double kPanelTop = 26.0;
constexpr double kPlotWide = 240.0;
constexpr double kPlotHigh = 96.0;

/// PanelAxes of one panel: log tau from left to right, ln ratio from bottom to top.
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

std::vector<const ScaleReport*> scales_of(const UnitReport& unit) {
  std::vector<const ScaleReport*> scales;
  for (const ScaleReport& test : unit.tests) {
    if (test.name.empty()) {
      scales.push_back(&test);
    }
  }
  return scales;
}

std::string ratio_panel(const UnitReport& unit, double scope_s) {
  const std::vector<const ScaleReport*> scales = scales_of(unit);
  std::string svg = svg_written("<text x=\"%.0f\" y=\"16\" font-weight=\"bold\">", kPanelLeft) +
                    svg_text(regression::short_name(unit.name)) + "</text>\n";
  if (scales.size() < 2) {
    return svg;
  }
  PanelAxes axes{scales.front()->test.tau_s, scales.back()->test.tau_s, 0.0};
  for (const ScaleReport* scale : scales) {
    const double margin = scale->test.tau_s <= scope_s ? scale->test.margin : 0.0;
    const double shown = scale->test.tau_s <= scope_s ? std::max(scale->outcome.upper, -scale->outcome.lower) : 0.0;
    axes.reach = std::max({axes.reach, 1.3 * margin, 1.1 * std::min(shown, 1.5), std::abs(scale->theta)});
  }
  if (scope_s >= axes.low_tau) {
    svg += svg_written("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"#eef2f6\"/>\n", kPanelLeft,
                       kPanelTop, std::min(axes.x(scope_s), kPanelLeft + kPlotWide) - kPanelLeft, kPlotHigh);
  }
  std::string band;
  std::string line;
  std::string margin;
  for (const ScaleReport* scale : scales) {
    band += svg_written("%.1f,%.1f ", axes.x(scale->test.tau_s), axes.y(scale->outcome.upper));
    line += svg_written("%.1f,%.1f ", axes.x(scale->test.tau_s), axes.y(scale->theta));
    margin += svg_written("%.1f,%.1f ", axes.x(scale->test.tau_s), axes.y(scale->test.margin));
  }
  for (auto scale = scales.rbegin(); scale != scales.rend(); ++scale) {
    band += svg_written("%.1f,%.1f ", axes.x((*scale)->test.tau_s), axes.y((*scale)->outcome.lower));
  }
  svg += "<polygon points=\"" + band + "\" fill=\"#4477aa\" fill-opacity=\"0.25\"/>\n";
  svg += svg_written("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"#888\"/>\n", kPanelLeft,
                     axes.y(0.0), kPanelLeft + kPlotWide, axes.y(0.0));
  svg += "<polyline points=\"" + margin + "\" fill=\"none\" stroke=\"#aa3333\" stroke-dasharray=\"5 3\"/>\n";
  svg += "<polyline points=\"" + line + "\" fill=\"none\" stroke=\"#224466\" stroke-width=\"1.5\"/>\n";
  for (const ScaleReport* scale : scales) {
    const bool beyond = scale->outcome.finding == regression::Finding::Beyond;
    const double x = axes.x(scale->test.tau_s);
    const double y = axes.y(scale->theta);
    svg += beyond ? svg_written("<path d=\"M%.1f %.1fl8 8m0 -8l-8 8\" stroke=\"#aa3333\" stroke-width=\"2\"/>\n",
                                x - 4.0, y - 4.0)
                  : svg_written("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2\" fill=\"#224466\"/>\n", x, y);
  }
  for (const double at : {-axes.reach, 0.0, axes.reach}) {
    svg += svg_written("<text x=\"%.0f\" y=\"%.1f\" text-anchor=\"end\">%+.0f %%</text>\n", kPanelLeft - 4.0,
                       axes.y(at) + 4.0, 100.0 * std::expm1(at));
  }
  for (const double tau_s : {axes.low_tau, axes.high_tau}) {
    svg += svg_written("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">", axes.x(tau_s),
                       kPanelTop + kPlotHigh + 15.0) +
           regression::duration_text(tau_s) + "</text>\n";
  }
  return svg;
}

/// Width of a text of 11 px in a common sans-serif face, generously.
double badge_width(const std::string& text) { return 6.6 * static_cast<double>(text.size()) + 12.0; }

std::string badge_words(const regression::Report& report) {
  if (report.verdict == regression::Verdict::Pass) {
    const bool gyroscope = std::any_of(report.units.begin(), report.units.end(),
                                       [](const UnitReport& unit) { return unit.sensor == "gyroscope"; });
    const double percent = gyroscope ? report.settings.gyroscope.percent[0] : report.settings.accelerometer.percent[0];
    return svg_written("no worse, %.3g %% to ", percent) + regression::duration_text(report.scope_s);
  }
  if (report.verdict == regression::Verdict::Fail) {
    if (const regression::ToldTest worst = regression::furthest_beyond(report); worst.test != nullptr) {
      return "worse: " + regression::short_name(worst.unit->name) + " " + regression::percent_text(worst.test->theta);
    }
    const auto failed = std::find_if(
        report.checks.begin(), report.checks.end(),
        [](const regression::EventCheck& check) { return check.verdict == regression::CheckVerdict::Fail; });
    return "worse: " + (failed == report.checks.end() ? std::string("see report") : failed->check);
  }
  const auto& sessions = report.comparison.needs.sessions_per_arm;
  if (!report.comparability.empty() || !sessions) {
    return "undecided";
  }
  return "undecided: " + with_count(*sessions, "session");
}

}  // namespace

std::string regression_to_svg(const RegressReport& run) {
  const regression::Report& report = run.report;
  const std::size_t columns = std::min<std::size_t>(3, std::max<std::size_t>(1, report.units.size()));
  const std::size_t lines = (report.units.size() + columns - 1) / columns;
  const double wide = kPanelWide * static_cast<double>(columns);
  const double high = kPanelHigh * static_cast<double>(lines) + 26.0;
  std::string svg = svg_written(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 "
      "%.0f %.0f\" font-family=\"sans-serif\" font-size=\"11\" role=\"img\">\n",
      wide, high, wide, high);
  svg += "<title>" + svg_text(report.summary.verdict) + "</title>\n";
  svg += svg_written("<rect width=\"%.0f\" height=\"%.0f\" fill=\"#ffffff\"/>\n", wide, high);
  for (std::size_t u = 0; u < report.units.size(); ++u) {
    const std::size_t line = u / columns;
    svg += svg_written("<g transform=\"translate(%.0f %.0f)\">\n", kPanelWide * static_cast<double>(u % columns),
                       kPanelHigh * static_cast<double>(line)) +
           ratio_panel(report.units[u], report.scope_s) + "</g>\n";
  }
  svg += svg_written(
      "<text x=\"%.0f\" y=\"%.0f\">Candidate over baseline [%%] against averaging time; band: all tests at "
      "once; dashed: margin; shaded: scope; cross: beyond</text>\n</svg>\n",
      8.0, high - 8.0);
  return svg;
}

std::string regression_to_badge(const RegressReport& run) {
  const std::string left = "sensor noise";
  const std::string right = badge_words(run.report);
  const char* const colour = run.report.verdict == regression::Verdict::Pass   ? "#2e7d32"
                             : run.report.verdict == regression::Verdict::Fail ? "#b3261e"
                                                                               : "#5f6368";
  const double a = badge_width(left);
  const double b = badge_width(right);
  std::string svg = svg_written(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"20\" role=\"img\" "
      "font-family=\"sans-serif\" font-size=\"11\" fill=\"#ffffff\">\n",
      a + b);
  svg += "<title>" + left + ": " + svg_text(right) + "</title>\n";
  svg += svg_written("<rect width=\"%.0f\" height=\"20\" fill=\"#3c4043\"/>\n", a);
  svg += svg_written("<rect x=\"%.0f\" width=\"%.0f\" height=\"20\" fill=\"%s\"/>\n", a, b, colour);
  svg += "<text x=\"6\" y=\"14\">" + left + "</text>\n";
  svg += svg_written("<text x=\"%.0f\" y=\"14\">", a + 6.0) + svg_text(right) + "</text>\n</svg>\n";
  return svg;
}

}  // namespace driftlab
