#include "schema/json/report_page.hpp"

#include "core/fit/characterise.hpp"
#include "core/signal/significant.hpp"
#include "schema/figure/drawing.hpp"
#include "schema/json/channel_summary.hpp"
#include "schema/json/figure_values.hpp"
#include "schema/json/figures.hpp"
#include "schema/json/regression_figures.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <vector>

namespace driftlab {
namespace {

constexpr const char* kStyle =
    "@page{size:A4;margin:16mm}"
    "body{font:14px/1.45 Inter,system-ui,\"Segoe UI\",Roboto,sans-serif;color:#16191d;max-width:960px;margin:24px "
    "auto;padding:0 16px}"
    "h1{font-size:24px;font-weight:600;margin:0}h2{font-size:15px;font-weight:600;margin:28px 0 4px}"
    ".meta,footer{color:#4a5056;font-size:13px}.verdict{font-size:19px;line-height:1.42;margin:16px 0 4px}"
    "ul{margin:4px 0 8px;padding-left:18px;color:#4a5056}svg{display:block;width:100%;height:auto;margin:8px 0}"
    "section{break-inside:avoid}pre{font:11px/1.4 ui-monospace,\"DejaVu Sans "
    "Mono\",monospace;white-space:pre-wrap;overflow-wrap:anywhere}"
    "table{border-collapse:collapse;font-size:13px}td,th{padding:3px 14px 3px 0;text-align:left;border-bottom:1px "
    "solid #e2e2dc}"
    "footer{margin-top:32px;border-top:1px solid #e2e2dc;padding-top:8px}"
    "@media print{body{margin:0;max-width:none;padding:0}}";

std::string html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return out;
}

std::string verdict_html(const std::string& sentence) {
  return sentence.empty() ? "" : "<p class=\"verdict\">" + html(sentence) + "</p>\n";
}

std::string list_html(const Json& sentences) {
  std::string items;
  for (const Json& sentence : sentences) {
    items += sentence.is_string() ? "<li>" + html(sentence.get<std::string>()) + "</li>\n" : "";
  }
  return items.empty() ? "" : "<ul>\n" + items + "</ul>\n";
}

std::string figures_html(const Json& document) {
  const auto figures = figures_of(document, "");
  std::string text;
  if (figures) {
    for (const NamedFigure& one : *figures) {
      text += "<section>\n<h2>" + html(one.figure.title) + "</h2>\n" + figure::to_svg(one.figure) + "</section>\n";
    }
  }
  return text;
}

std::string mark_of(const std::string& level) { return level == "fine" ? "✓" : level == "wrong" ? "✗" : "△"; }

/// A recording: for each channel its sentence, the evidence and its figure; then what is true of the file.
std::string recording_html(const Json& recording) {
  const auto id = recording.at("id").get<std::string>();
  std::string text = "<h2>" + html(id) + "</h2>\n" + list_html(recording.at("quality").at("notes"));
  for (const Json& channel : recording.at("channels")) {
    const auto summary = channel_summary(channel);
    text += "<section>\n<h2>" + html(channel.at("channel").get<std::string>()) + "</h2>\n";
    if (summary) {
      text += verdict_html(mark_of(summary->value("level", "")) + " " + summary->value("verdict", "")) +
              list_html(summary->at("details"));
    }
    if (!channel.at("allan").at("tau_s").empty()) {
      text += figure::to_svg(allan_figure(channel, id));
    }
    text += list_html(channel.at("warnings")) + "</section>\n";
  }
  return text;
}

std::string characterisation_html(const Json& document) {
  std::string text;
  for (const Json& recording : document.at("recordings")) {
    text += recording_html(recording);
  }
  return text;
}

/// A member that is a text; empty where it is null or absent.
std::string text_of(const Json& object, const char* member) {
  const Json value = object.value(member, Json(nullptr));
  return value.is_string() ? value.get<std::string>() : "";
}

std::string row_html(const std::vector<std::string>& cells, const char* tag = "td") {
  std::string row = "<tr>";
  for (const std::string& cell : cells) {
    row += std::string("<") + tag + ">" + html(cell) + "</" + tag + ">";
  }
  return row + "</tr>\n";
}

/// A table under its heading; nothing without rows.
std::string table_html(const std::string& heading, const std::vector<std::string>& columns, const std::string& rows) {
  return rows.empty() ? ""
                      : "<section>\n<h2>" + html(heading) + "</h2>\n<table>" + row_html(columns, "th") + rows +
                            "</table>\n</section>\n";
}

/// Members of a list, joined by commas.
std::string joined(const Json& words) {
  std::string text;
  for (const Json& one : words) {
    text += (text.empty() ? "" : ", ") + one.get<std::string>();
  }
  return text;
}

std::string parameters_of(const Json& params) {
  std::string text;
  for (const auto& [name, value] : params.items()) {
    if (value.is_object() && value.value("value", Json(nullptr)).is_number()) {
      text += (text.empty() ? "" : "; ") + name + " = " + quantity_text(value);
    }
  }
  return text;
}

std::string finding_html(const Json& finding) {
  const auto status = text_of(finding, "status");
  const std::string others = joined(finding.value("alternatives", Json::array()));
  std::string text = "<section>\n<h2>" + html(finding.value("title", finding.at("cause").get<std::string>())) +
                     "</h2>\n<p>" + html(text_of(finding, "explanation")) + "</p>\n";
  text += "<p class=\"meta\">" + html(finding.at("cause").get<std::string>()) + ", " +
          html(status + (others.empty() ? "" : ": or " + others)) + "; " +
          html(joined(finding.value("channels", Json::array()))) + "</p>\n";
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
    rows += row_html({name, quantity_text(value),
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
      rows += row_html({text_of(check, "channel"), text_of(check, "recording"), text_of(check, "title"),
                        chance("p_adjusted"), chance("p_after_adjusted"),
                        after             ? "still fails"
                        : end.is_string() ? "passes: " + end.get<std::string>()
                                          : "passes"});
    }
  }
  const std::string count = std::to_string(checks.size());
  return rows.empty()
             ? "<p>All " + count + " checks pass.</p>\n"
             : table_html("Checks that failed, of " + count,
                          {"channel", "recording", "check", "p before", "p after", "with what was found"}, rows);
}

std::string extended_html(const Json& model) {
  std::string rows;
  const auto add = [&rows](const std::string& where, const Json& processes) {
    for (const Json& process : processes) {
      rows += row_html({where, text_of(process, "process"), parameters_of(process.value("params", Json::object()))});
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
    rows += row_html({joined(effect.value("channels", Json::array())), text_of(effect, "cause"),
                      parameters_of(effect.value("params", Json::object()))});
  }
  return table_html("Extended model", {"channel", "process or effect", "parameters"}, rows);
}

std::string investigation_html(const Json& document) {
  const Json summary = document.value("summary", Json::object());
  std::string text = verdict_html(mark_of(text_of(summary, "level")) + " " + text_of(summary, "verdict")) +
                     list_html(summary.value("details", Json::array()));
  if (document.at("findings").empty()) {
    text += "<p>Nothing was found: what was measured agrees with what the baseline simulates.</p>\n";
  }
  for (const Json& finding : document.at("findings")) {
    text += finding_html(finding);
  }
  Json sentences = Json::array();
  for (const Json& one : document.value("unexplained", Json::array())) {
    sentences.push_back(text_of(one, "explanation"));
  }
  text += sentences.empty() ? "" : "<h2>Unexplained</h2>\n" + list_html(sentences);
  text += figures_html(document) + checks_html(document.value("checks", Json::array())) +
          extended_html(document.value("extended_model", Json::object()));
  std::string unseen;
  for (const Json& one : document.value("not_examined", Json::array())) {
    unseen += row_html({text_of(one, "channel"), text_of(one, "cause"), text_of(one, "needs")});
  }
  return text + table_html("Not examined", {"channel", "cause", "would need"}, unseen) +
         list_html(document.value("notes", Json::array()));
}

std::string percent(double ratio) {
  std::array<char, 32> buffer{};
  (void)std::snprintf(buffer.data(), buffer.size(), "%+.1f %%", 100.0 * (ratio - 1.0));
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
      rows += row_html({unit_name(unit),
                        tau.is_number() ? figure::tick_text(tau.get<double>()) + " s" : text_of(test, "name"),
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
      const std::string label = text_of(arms.at(arm), "label");
      rows += row_html({arm + (label.empty() ? "" : " (" + label + ")"), text_of(session, "session"),
                        joined(session.value("recordings", Json::array())),
                        figure::tick_text(session.at("duration_s").get<double>()) + " s"});
    }
  }
  return table_html("Sessions", {"arm", "session", "recordings", "length"}, rows);
}

/// What was looked at beside the noise, and how it ended.
std::string comparisons_html(const Json& findings) {
  std::string rows;
  for (const Json& finding : findings) {
    rows += row_html(
        {replaced(text_of(finding, "check"), "_", " "), text_of(finding, "verdict"), text_of(finding, "sentence")});
  }
  return table_html("Recordings compared", {"check", "verdict", ""}, rows);
}

std::string regression_html(const Json& document) {
  const Json& summary = document.at("summary");
  const Json& settings = document.at("settings");
  const Json& look = document.at("look");
  return verdict_html(mark_of(text_of(summary, "level")) + " " + text_of(summary, "verdict")) +
         list_html(summary.at("details")) + figures_html(document) + tests_html(document.at("units")) +
         comparisons_html(document.at("findings")) + arms_html(document.at("arms")) + "<p class=\"meta\">" +
         html("Look " + std::to_string(look.at("number").get<int>()) + " of " +
              std::to_string(look.at("of").get<int>()) + ", error rate " +
              figure::tick_text(settings.at("alpha").get<double>()) + " in all, seed " +
              std::to_string(settings.at("seed").get<std::uint64_t>()) + ".") +
         "</p>\n";
}

/// A number of a document with the digits that its interval lets stand, and the interval.
std::string written(double value, const Json& ci95) {
  const double low = ci95.at(0).get<double>();
  const double high = ci95.at(1).get<double>();
  return significant(value, low, high) + " [" + significant(low, low, high) + ", " + significant(high, low, high) + "]";
}

std::string outages_html(const Json& document) {
  const Json summary = document.value("summary", Json::object());
  std::string filters;
  for (const Json& filter : document.at("filters")) {
    const Json& error = filter.at("mean_error_m");
    filters += row_html({text_of(filter, "name"), std::to_string(filter.at("states").get<int>()),
                         written(error.at("value").get<double>(), error.at("ci95")),
                         written(filter.at("nees").get<double>(), filter.at("nees_ci95")),
                         std::to_string(std::lround(100.0 * filter.at("coverage95").get<double>())) + " %"});
  }
  std::string claims;
  for (const Json& claim : document.at("claims")) {
    claims += row_html({text_of(claim, "claim"), claim.at("supported").get<bool>() ? "supported" : "not supported",
                        text_of(claim, "because")});
  }
  return verdict_html(text_of(summary, "verdict")) + list_html(summary.value("details", Json::array())) +
         figures_html(document) +
         table_html("Filters", {"filter", "states", "mean error [m]", "NEES", "in its 95 % ellipse"}, filters) +
         table_html("What the paper claims", {"claim", "", "because"}, claims) + "<p class=\"meta\">" +
         html(std::to_string(document.at("runs").get<int>()) + " runs, seed " +
              std::to_string(document.at("seed").get<std::uint64_t>()) + ", algorithm " +
              std::to_string(document.at("algorithm_version").get<int>()) + ".") +
         "</p>\n";
}

std::string body_of(const Json& document) {
  if (document.contains("recordings") && document["recordings"].is_array() && !document["recordings"].empty() &&
      document["recordings"].front().contains("channels")) {
    return characterisation_html(document);
  }
  if (document.contains("units") && document.contains("verdict")) {
    return regression_html(document);
  }
  if (document.contains("findings")) {
    return investigation_html(document);
  }
  if (document.contains("filters") && document.contains("claims")) {
    return outages_html(document);
  }
  const Json summary = document.value("summary", Json(nullptr));
  return (summary.is_object() ? verdict_html(summary.value("verdict", "")) : "") + figures_html(document);
}

}  // namespace

Result<std::string> report_page(const Json& document, const std::string& device, const std::string& tables) {
  if (!document.is_object()) {
    return fail(ErrorCode::InvalidArgument, "The file holds no document of driftlab.");
  }
  try {
    const std::string body = body_of(document);
    if (body.empty()) {
      const auto figures = figures_of(document, "");
      return fail(figures ? Error{ErrorCode::InvalidArgument, "The document has nothing to report.", {}}
                          : figures.error());
    }
    const std::string title = device.empty() ? document.value("study", Json("")).is_string()
                                                   ? document.value("study", "driftlab report")
                                                   : "driftlab report"
                                             : device;
    std::string page = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + html(title) +
                       "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + html(title) + "</h1>\n" +
                       body;
    if (!tables.empty()) {
      page += "<h2>Parameters</h2>\n<pre>" + html(tables) + "</pre>\n";
    }
    return page + "<footer>driftlab " DRIFTLAB_VERSION ", algorithm " + std::to_string(kAlgorithmVersion) +
           "</footer>\n</body>\n</html>\n";
  } catch (const Json::exception& error) {
    return fail(ErrorCode::Internal, std::string("The document is not as driftlab writes it: ") + error.what());
  }
}

std::string verdict_lines(const Json& characterisation) {
  std::string text;
  const bool several = characterisation.at("recordings").size() > 1;
  for (const Json& recording : characterisation.at("recordings")) {
    for (const Json& channel : recording.at("channels")) {
      if (const auto summary = channel_summary(channel)) {
        text += mark_of(summary->value("level", "")) + " " +
                (several ? recording.at("id").get<std::string>() + ", " : "") +
                channel.at("channel").get<std::string>() + ": " + summary->value("verdict", "") + "\n";
      }
    }
  }
  return text;
}

}  // namespace driftlab
