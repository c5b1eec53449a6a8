#include "schema/json/report/html.hpp"

#include "core/signal/significant.hpp"
#include "schema/figure/drawing.hpp"
#include "schema/figure/paper.hpp"
#include "schema/figure/printed_names.hpp"
#include "schema/json/figure_values.hpp"
#include "schema/json/figures.hpp"

namespace driftlab::page {
namespace {

constexpr const char* kStyle =
    "@page{size:A4;margin:16mm}"
    "body{font:14px/1.45 Inter,system-ui,\"Segoe UI\",Roboto,sans-serif;color:#16191d;max-width:960px;margin:24px "
    "auto;padding:0 16px}"
    "h1{font-size:24px;font-weight:600;margin:0}h2{font-size:15px;font-weight:600;margin:28px 0 4px}"
    ".meta,footer{color:#4a5056;font-size:13px}.verdict{font-size:19px;line-height:1.42;margin:16px 0 4px}"
    ".equation{margin:4px 0 4px 16px}"
    "ul{margin:4px 0 8px;padding-left:18px;color:#4a5056}svg{display:block;width:100%;height:auto;margin:8px 0}"
    "section{break-inside:avoid}pre{font:11px/1.4 ui-monospace,\"DejaVu Sans "
    "Mono\",monospace;white-space:pre-wrap;overflow-wrap:anywhere}"
    "table{border-collapse:collapse;font-size:13px}td,th{padding:3px 14px 3px 0;text-align:left;border-bottom:1px "
    "solid #e2e2dc}"
    "footer{margin-top:32px;border-top:1px solid #e2e2dc;padding-top:8px}"
    "@media print{body{margin:0;max-width:none;padding:0}}";

}  // namespace

std::string framed(const std::string& title, const std::string& body) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + html(title) +
         "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<h1>" + html(title) + "</h1>\n" + body +
         "</body>\n</html>\n";
}

std::string html(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  }
  return out;
}

std::string verdict_html(const std::string& sentence) {
  return sentence.empty() ? "" : "<p class=\"verdict\">" + html(printed_unit(sentence)) + "</p>\n";
}

std::string list_html(const Json& sentences) {
  std::string items;
  for (const Json& sentence : sentences) {
    items += sentence.is_string() ? "<li>" + html(printed_unit(sentence.get<std::string>())) + "</li>\n" : "";
  }
  return items.empty() ? "" : "<ul>\n" + items + "</ul>\n";
}

std::string aligned_html(const std::string& text) {
  return "<pre style=\"font-size:" + figure::aligned_type_size(text) + "\">" + html(text) + "</pre>\n";
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

std::string with_interval(double value, const Json& ci95) {
  const bool stated = ci95.is_array() && ci95.size() == 2;
  const auto low = stated ? value_of(ci95[0]) : std::nullopt;
  const auto high = stated ? value_of(ci95[1]) : std::nullopt;
  std::string text = significant(value, low, high);
  if (low || high) {
    text +=
        " [" + (low ? significant(*low, low, high) : "—") + ", " + (high ? significant(*high, low, high) : "—") + "]";
  }
  return text;
}

std::string row_html(const std::vector<std::string>& cells, const char* tag) {
  std::string row = "<tr>";
  for (const std::string& cell : cells) {
    row += std::string("<") + tag + ">" + html(cell) + "</" + tag + ">";
  }
  return row + "</tr>\n";
}

std::string table_html(const std::string& heading, const std::vector<std::string>& columns, const std::string& rows) {
  return rows.empty() ? ""
                      : "<section>\n<h2>" + html(heading) + "</h2>\n<table>" + row_html(columns, "th") + rows +
                            "</table>\n</section>\n";
}

std::string with_commas(const Json& words) {
  std::string text;
  for (const Json& one : words) {
    text += (text.empty() ? "" : ", ") + one.get<std::string>();
  }
  return text;
}

}  // namespace driftlab::page
