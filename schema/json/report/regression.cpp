/// The report of a regression run: verdict, figures, the tests that decide, what else was compared, and the sessions.
#include "core/campaign/regression/ratios.hpp"
#include "schema/figure/drawing.hpp"
#include "schema/json/figure_values.hpp"
#include "schema/json/regression_figures.hpp"
#include "schema/json/report/bodies.hpp"
#include "schema/json/report/html.hpp"
#include "schema/json/stored_member.hpp"

#include <array>
#include <cstdint>
#include <cstdio>

namespace driftlab::page {
namespace {

std::string percent(double ratio) {
  std::array<char, 32> buffer{};
  (void)std::snprintf(buffer.data(), buffer.size(), "%+.1f %%", regression::change_percent(ratio));
  return buffer.data();
}

/// A row for each test that decides, or that is beyond its margin.
std::string tests_html(const Json& units) {
  std::string rows;
  for (const Json& unit : units) {
    for (const Json& test : unit.at("tests")) {
      const auto verdict = test.at("verdict").get<std::string>();
      if (!test.value("gated", false) && verdict != "beyond") {
        continue;
      }
      const Json tau = test.value("tau_s", Json(nullptr));
      rows += row_html(
          {unit_name(unit),
           tau.is_number() ? figure::tick_text(tau.get<double>()) + " s" : column_name(text_member(test, "name")),
           percent(test.at("ratio").get<double>()),
           percent(test.at("ci")[0].get<double>()) + " to " + percent(test.at("ci")[1].get<double>()),
           percent(test.at("margin").get<double>()), verdict});
    }
  }
  return table_html("Tests", {"axis", "averaging time", "change", "interval, all tests at once", "margin", ""}, rows);
}

std::string arms_html(const Json& arms) {
  std::string rows;
  for (const char* const arm : {"baseline", "candidate"}) {
    for (const Json& session : arms.at(arm).at("sessions")) {
      const std::string label = text_member(arms.at(arm), "label");
      rows += row_html({arm + (label.empty() ? "" : " (" + label + ")"), text_member(session, "session"),
                        with_commas(session.value("recordings", Json::array())),
                        figure::tick_text(session.at("duration_s").get<double>()) + " s"});
    }
  }
  return table_html("Sessions", {"arm", "session", "recordings", "length"}, rows);
}

/// What was looked at beside the noise, and how it ended.
std::string comparisons_html(const Json& findings) {
  std::string rows;
  for (const Json& finding : findings) {
    rows += row_html({replaced(text_member(finding, "check"), "_", " "), text_member(finding, "verdict"),
                      text_member(finding, "sentence")});
  }
  return table_html("Recordings compared", {"check", "verdict", ""}, rows);
}

}  // namespace

std::string regression_html(const Json& document) {
  const Json& summary = document.at("summary");
  const Json& settings = document.at("settings");
  const Json& look = document.at("look");
  return verdict_html(mark_of(text_member(summary, "level")) + " " + text_member(summary, "verdict")) +
         list_html(summary.at("details")) + figures_html(document) + tests_html(document.at("units")) +
         comparisons_html(document.at("findings")) + arms_html(document.at("arms")) + "<p class=\"meta\">" +
         html("Look " + std::to_string(look.at("number").get<int>()) + " of " +
              std::to_string(look.at("of").get<int>()) + ", error rate " +
              figure::tick_text(settings.at("alpha").get<double>()) + " in all, seed " +
              std::to_string(settings.at("seed").get<std::uint64_t>()) + ".") +
         "</p>\n";
}

}  // namespace driftlab::page
