#pragma once
/// What every report is written in: the page around it, and paragraphs, lists, tables and figures of HTML. Whatever a
/// document holds is text there. Internal to schema/json.
#include "schema/json/json.hpp"

#include <string>
#include <vector>

namespace driftlab::page {

/// A whole page that prints on A4: the style is in it, and nothing else is asked for.
[[nodiscard]] std::string framed(const std::string& title, const std::string& body);

/// `text` with the characters of markup written out.
[[nodiscard]] std::string html(const std::string& text);

/// The sentence that a report begins with, its units in print; nothing where there is none.
[[nodiscard]] std::string verdict_html(const std::string& sentence);

/// The sign of a level: fine, wrong, or to be looked at.
[[nodiscard]] std::string mark_of(const std::string& level);

/// The members of a list that are text, with units in print; nothing where there are none.
[[nodiscard]] std::string list_html(const Json& sentences);

/// Tables that are aligned by blanks, in characters as small as their longest row needs on A4.
[[nodiscard]] std::string aligned_html(const std::string& text);

/// Every figure of the document under its title.
[[nodiscard]] std::string figures_html(const Json& document);

[[nodiscard]] std::string row_html(const std::vector<std::string>& cells, const char* tag = "td");

/// A table under its heading; nothing without rows.
[[nodiscard]] std::string table_html(const std::string& heading, const std::vector<std::string>& columns,
                                     const std::string& rows);

/// A number of a document and its interval `ci95`, each with the digits that the interval lets stand: `1.04 [1.02,
/// 1.05]`, a bound that is null a dash, and the number alone where there is no interval.
[[nodiscard]] std::string with_interval(double value, const Json& ci95);

/// Members of a list, joined by commas.
[[nodiscard]] std::string with_commas(const Json& words);

}  // namespace driftlab::page
