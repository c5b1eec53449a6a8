/// The report of an investigation: verdict, findings, figures, checks, the extended model and what was not examined.
#include "core/signal/significant.hpp"
#include "schema/figure/drawing.hpp"
#include "schema/json/figure_values.hpp"
#include "schema/json/report/bodies.hpp"
#include "schema/json/report/html.hpp"
#include "schema/json/stored_member.hpp"

namespace driftlab::page {
namespace {

std::string parameters_of(const Json& params) {
  std::string text;
  for (const auto& [name, value] : params.items()) {
    if (value.is_object() && value.value("value", Json(nullptr)).is_number()) {
      text += (text.empty() ? "" : "; ") + parameter_name(name) + " = " + quantity_text(value);
    }
  }
  return text;
}

/// A cause as people write it.
std::string cause_name(const Json& named) { return replaced(text_member(named, "cause"), "_", " "); }

std::string finding_html(const Json& finding) {
  const auto status = text_member(finding, "status");
  const std::string others = replaced(with_commas(finding.value("alternatives", Json::array())), "_", " ");
  std::string text = "<section>\n<h2>" + html(finding.value("title", cause_name(finding))) + "</h2>\n<p>" +
                     html(printed_unit(text_member(finding, "explanation"))) + "</p>\n";
  if (const std::string equation = text_member(finding, "equation"); !equation.empty()) {
    text += "<p class=\"equation\">" + html(equation) + "</p>\n";
  }
  text += "<p class=\"meta\">" + html(cause_name(finding)) + ", " +
          html(status + (others.empty() ? "" : ": or " + others)) + "; " +
          html(with_commas(finding.value("channels", Json::array()))) + "</p>\n";
  std::string rows;
  const Json parameters = finding.value("parameters", Json::object());
  for (const auto& [name, value] : parameters.items()) {
    if (!value.is_object() || !value.value("value", Json(nullptr)).is_number()) {
      continue;
    }
    const Json ci95 = value.value("ci95", Json(nullptr));
    const bool bounded = ci95.is_array() && ci95.size() == 2 && ci95[0].is_number() && ci95[1].is_number();
    const double low = bounded ? ci95[0].get<double>() : 0.0;
    const double high = bounded ? ci95[1].get<double>() : 0.0;
    rows += row_html({parameter_name(name), quantity_text(value),
                      bounded ? significant(low, low, high) + " to " + significant(high, low, high) : ""});
  }
  return text +
         (rows.empty() ? ""
                       : "<table>" + row_html({"parameter", "estimate", "95 % interval"}, "th") + rows + "</table>\n") +
         "</section>\n";
}

/// Checks that failed before or after, then how many there were.
std::string checks_html(const Json& checks) {
  std::string rows;
  for (const Json& check : checks) {
    const bool before = check.value("failed", false);
    const bool after = check.value("failed_after", false);
    if (before || after) {
      const auto chance = [&](const char* member) {
        const Json p = check.value(member, Json(nullptr));
        return p.is_number() ? figure::tick_text(p.get<double>()) : std::string("not made");
      };
      const Json end = check.value("end", Json(nullptr));
      rows += row_html({text_member(check, "channel"), text_member(check, "recording"), text_member(check, "title"),
                        chance("p_adjusted"), chance("p_after_adjusted"),
                        after             ? "still fails"
                        : end.is_string() ? "passes: " + end.get<std::string>()
                                          : "passes"});
    }
  }
  const std::string count = std::to_string(checks.size());
  return rows.empty()
             ? (checks.size() == 1 ? std::string("<p>The one check passes.</p>\n")
                                   : "<p>All " + count + " checks pass.</p>\n")
             : table_html("Checks that failed, of " + count,
                          {"channel", "recording", "check", "p before", "p after", "with what was found"}, rows);
}

std::string extended_html(const Json& model) {
  std::string rows;
  const auto add = [&rows](const std::string& where, const Json& processes) {
    for (const Json& process : processes) {
      rows += row_html({where, process_name(text_member(process, "process")),
                        parameters_of(process.value("params", Json::object()))});
    }
  };
  const Json channels = model.value("channels", Json::object());
  if (channels.empty()) {
    add("all", model.value("processes", Json::array()));
  }
  for (const auto& [name, channel] : channels.items()) {
    add(name, channel.value("processes", Json::array()));
  }
  for (const Json& effect : model.value("effects", Json::array())) {
    rows += row_html({with_commas(effect.value("channels", Json::array())), cause_name(effect),
                      parameters_of(effect.value("params", Json::object()))});
  }
  return table_html("Extended model", {"channel", "process or effect", "parameters"}, rows);
}

}  // namespace

std::string investigation_html(const Json& document) {
  const Json summary = document.value("summary", Json::object());
  std::string text = verdict_html(mark_of(text_member(summary, "level")) + " " + text_member(summary, "verdict")) +
                     list_html(summary.value("details", Json::array()));
  if (document.at("findings").empty()) {
    text += "<p>Nothing was found: what was measured agrees with what the baseline simulates.</p>\n";
  }
  for (const Json& finding : document.at("findings")) {
    text += finding_html(finding);
  }
  Json sentences = Json::array();
  for (const Json& one : document.value("unexplained", Json::array())) {
    sentences.push_back(text_member(one, "explanation"));
  }
  text += sentences.empty() ? "" : "<h2>Unexplained</h2>\n" + list_html(sentences);
  Json profiles = Json::array();
  for (const Json& one : document.value("unnamed", Json::array())) {
    profiles.push_back(text_member(one, "explanation"));
  }
  text += profiles.empty() ? "" : "<h2>In the extended model without a name</h2>\n" + list_html(profiles);
  text += figures_html(document) + checks_html(document.value("checks", Json::array())) +
          extended_html(document.value("extended_model", Json::object()));
  std::string unseen;
  for (const Json& one : document.value("not_examined", Json::array())) {
    unseen += row_html({text_member(one, "channel"), cause_name(one), text_member(one, "needs")});
  }
  return text + table_html("Not examined", {"channel", "cause", "would need"}, unseen) +
         list_html(document.value("notes", Json::array()));
}

}  // namespace driftlab::page
