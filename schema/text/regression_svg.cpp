/// Figure and badge of a regression run, as SVG.
#include "core/signal/short_name.hpp"
#include "core/signal/with_count.hpp"
#include "schema/figure/ratio_panels.hpp"
#include "schema/text/printed.hpp"
#include "schema/text/regression.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {
namespace {

using regression::ScaleReport;
using regression::UnitReport;

figure::RatioPanel panel_of(const UnitReport& unit) {
  figure::RatioPanel panel{.name = short_sensor_name(unit.name)};
  for (const ScaleReport& scale : unit.tests) {
    if (scale.name.empty()) {
      panel.points.push_back({.tau_s = scale.test.tau_s,
                              .ln_ratio = scale.theta,
                              .low = scale.outcome.lower,
                              .high = scale.outcome.upper,
                              .margin = scale.test.margin,
                              .crossed = scale.outcome.finding == regression::Finding::Beyond});
    }
  }
  if (!panel.points.empty()) {
    panel.end_words = {regression::duration_text(panel.points.front().tau_s),
                       regression::duration_text(panel.points.back().tau_s)};
  }
  return panel;
}

std::string badge_words(const regression::Report& report) {
  if (report.verdict == regression::Verdict::Pass) {
    const bool gyroscope = std::any_of(report.units.begin(), report.units.end(),
                                       [](const UnitReport& unit) { return unit.sensor == "gyroscope"; });
    const double percent = gyroscope ? report.settings.gyroscope.percent[0] : report.settings.accelerometer.percent[0];
    return printed("no worse, %.3g %% to ", percent) + regression::duration_text(report.scope_s);
  }
  if (report.verdict == regression::Verdict::Fail) {
    if (const regression::ToldTest worst = regression::furthest_beyond(report); worst.test != nullptr) {
      return "worse: " + short_sensor_name(worst.unit->name) + " " + regression::percent_text(worst.test->theta);
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
  figure::RatioPanels figure{
      .title = run.report.summary.verdict,
      .caption =
          "Candidate over baseline [%] against averaging time; band: all tests at once; dashed: margin; shaded: "
          "scope; cross: beyond",
      .scope_s = run.report.scope_s};
  for (const UnitReport& unit : run.report.units) {
    figure.panels.push_back(panel_of(unit));
  }
  return figure::to_svg(figure);
}

std::string regression_to_badge(const RegressReport& run) {
  const char* const colour = run.report.verdict == regression::Verdict::Pass   ? "#2e7d32"
                             : run.report.verdict == regression::Verdict::Fail ? "#b3261e"
                                                                               : "#5f6368";
  return figure::badge_svg("sensor noise", badge_words(run.report), colour);
}

}  // namespace driftlab
