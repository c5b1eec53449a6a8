#include "schema/json/report_page.hpp"

#include "core/fit/characterise.hpp"
#include "schema/figure/drawing.hpp"
#include "schema/json/channel_summary.hpp"
#include "schema/json/figures.hpp"

#include <array>
#include <cstdio>

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

std::string investigation_html(const Json& document) {
  std::string text = verdict_html(document.value("verdict", Json("")).is_string() ? document.value("verdict", "") : "");
  text += "<h2>Findings</h2>\n";
  if (document.at("findings").empty()) {
    text += "<p>None: what was measured agrees with what the baseline simulates.</p>\n";
  }
  for (const Json& finding : document.at("findings")) {
    text += "<section>\n<h2>" + html(finding.at("cause").get<std::string>()) + " (" +
            html(finding.value("status", "")) + ")</h2>\n<p>" + html(finding.value("explanation", "")) +
            "</p>\n</section>\n";
  }
  Json sentences = Json::array();
  for (const Json& one : document.value("unexplained", Json::array())) {
    sentences.push_back(one.value("explanation", ""));
  }
  text += sentences.empty() ? "" : "<h2>Unexplained</h2>\n" + list_html(sentences);
  return text + figures_html(document) + list_html(document.value("notes", Json::array()));
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
    for (const Json& test : unit.value("tests", Json::array())) {
      const auto verdict = test.at("verdict").get<std::string>();
      if (!test.value("gated", false) && verdict != "beyond") {
        continue;
      }
      const Json tau = test.value("tau_s", Json(nullptr));
      rows += "<tr><td>" + html(unit.value("name", "")) + "</td><td>" +
              (tau.is_number() ? figure::tick_text(tau.get<double>()) + " s" : html(test.value("name", ""))) +
              "</td><td>" + percent(test.at("ratio").get<double>()) + "</td><td>" +
              percent(test.at("ci")[0].get<double>()) + " .. " + percent(test.at("ci")[1].get<double>()) + "</td><td>" +
              html(verdict) + "</td></tr>\n";
    }
  }
  return rows.empty() ? ""
                      : "<table><tr><th>axis</th><th>averaging time</th><th>change</th><th>interval, all tests at "
                        "once</th><th></th></tr>\n" +
                            rows + "</table>\n";
}

std::string regression_html(const Json& document) {
  const Json& summary = document.at("summary");
  return verdict_html(mark_of(summary.value("level", "")) + " " + summary.value("verdict", "")) +
         list_html(summary.at("details")) + "<h2>Tests</h2>\n" + tests_html(document.at("units"));
}

std::string body_of(const Json& document) {
  if (document.contains("recordings") && document["recordings"].is_array() && !document["recordings"].empty() &&
      document["recordings"].front().contains("channels")) {
    return characterisation_html(document);
  }
  if (document.contains("findings")) {
    return investigation_html(document);
  }
  if (document.contains("units") && document.contains("verdict")) {
    return regression_html(document);
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
