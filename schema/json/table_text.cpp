#include "core/signal/number.hpp"
#include "schema/json/parameter_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace driftlab {
namespace {

/// Four significant digits, without an exponent where people would not write one.
std::string rounded(const Json& value) {
  if (!value.is_number()) {
    return "";
  }
  std::array<char, 48> buffer{};
  const double x = value.get<double>();
  const double size = std::fabs(x);
  const bool plain = size == 0.0 || (size >= 1e-3 && size < 1e5);
  int decimals = 0;
  if (plain && size > 0.0) {
    decimals = std::clamp(3 - static_cast<int>(std::floor(std::log10(size))), 0, 6);
  }
  const int length = plain ? std::snprintf(buffer.data(), buffer.size(), "%.*f", decimals, x)
                           : std::snprintf(buffer.data(), buffer.size(), "%.3e", x);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

std::string cell_text(const Json& cell) {
  if (!cell.is_object()) {
    return "…";
  }
  const Json& low = cell["ci95"][0];
  const Json& high = cell["ci95"][1];
  std::string text = rounded(cell["value"]) + " [" + (low.is_null() ? "…" : rounded(low)) + ", " +
                     (high.is_null() ? "…" : rounded(high)) + "]";
  const Json change = cell.value("change", Json());
  if (change == "up") {
    text += " ↑";
  } else if (change == "down") {
    text += " ↓";
  }
  return text;
}

/// Characters a person sees: UTF-8 continuation bytes take no room.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string result = "\"";
  for (const char c : text) {
    result += c;
    if (c == '"') {
      result += '"';
    }
  }
  return result + "\"";
}

std::string unit_suffix(const Json& column, const char* open, const char* close) {
  return column["unit"].is_string() ? std::string(" ") + open + column["unit"].get<std::string>() + close : "";
}

/// What a reader must know before using a row: contamination and what the fit itself says against it.
std::string notes_of(const Json& table) {
  std::string text;
  for (const Json& row : table.at("rows")) {
    const std::string label = row["label"].get<std::string>();
    if (row.value("contamination", Json()) == "contaminated") {
      text += "! " + label + ": gross errors move the variances of this recording" +
              (row.value("robust", false) ? "; the values are from robust variances.\n" : ".\n");
    }
    if (const Json agreement = row.value("agreement", Json()); agreement.is_object() && agreement["agree"] == false) {
      text += "! " + label + ": its recordings disagree (p = " + rounded(agreement["p"]) +
              "); the pooled values stand for none of them.\n";
    }
    for (const Json& warning : row.value("warnings", Json::array())) {
      text += "! " + label + ": " + warning.get<std::string>() + "\n";
    }
  }
  return text;
}

/// `*` where a note below speaks of the row itself.
std::string marked_label(const Json& row) {
  const Json agreement = row.value("agreement", Json());
  const bool marked =
      row.value("contamination", Json()) == "contaminated" || (agreement.is_object() && agreement["agree"] == false);
  return row["label"].get<std::string>() + (marked ? " *" : "");
}

std::string heading_of(const Json& table) {
  std::string text = table["device"].get<std::string>() + ", " + table["sensor"].get<std::string>();
  if (table["axis"].is_string()) {
    text += " " + table["axis"].get<std::string>();
  }
  return text + (table["method"] == "av"
                     ? ", Allan variance"
                     : ", GMWM, model " + (table["model"].is_string() ? table["model"].get<std::string>() : "?"));
}

/// Lines of the table: keys, units, one per row.
std::vector<std::vector<std::string>> grid_of(const Json& table) {
  std::vector<std::vector<std::string>> grid(2, {"condition"});
  grid[1] = {""};
  for (const Json& column : table.at("columns")) {
    grid[0].push_back(column["key"].get<std::string>());
    grid[1].push_back(column["unit"].is_string() ? column["unit"].get<std::string>() : "");
  }
  for (const Json& row : table.at("rows")) {
    std::vector<std::string> line{marked_label(row)};
    for (const Json& column : table.at("columns")) {
      line.push_back(cell_text(row["values"][column["key"].get<std::string>()]));
    }
    grid.push_back(std::move(line));
  }
  return grid;
}

constexpr const char* kLegend = "value [95 % interval]; … not identifiable; ↑ ↓ changed against the first row";

std::string exact(const Json& value) { return value.is_number() ? to_text(value.get<double>()) : ""; }

}  // namespace

std::string table_to_csv(const Json& table) {
  std::string text = "condition,recordings";
  for (const Json& column : table.at("columns")) {
    const std::string key = column["key"].get<std::string>();
    const std::string unit = unit_suffix(column, "[", "]");
    for (const char* const part : {"", " low", " high"}) {
      text.append(",").append(csv_field(std::string(key).append(part).append(unit)));
    }
  }
  text += "\r\n";
  for (const Json& row : table.at("rows")) {
    std::string recordings;
    for (const Json& id : row["recordings"]) {
      recordings += (recordings.empty() ? "" : " ") + id.get<std::string>();
    }
    text += csv_field(row["label"].get<std::string>()) + "," + csv_field(recordings);
    for (const Json& column : table.at("columns")) {
      const Json& cell = row["values"][column["key"].get<std::string>()];
      if (cell.is_object()) {
        text += "," + exact(cell["value"]) + "," + exact(cell["ci95"][0]) + "," + exact(cell["ci95"][1]);
      } else {
        text += ",,,";
      }
    }
    text += "\r\n";
  }
  return text;
}

std::string table_to_text(const Json& table) {
  const std::vector<std::vector<std::string>> grid = grid_of(table);
  std::vector<std::size_t> widths(grid[0].size(), 0);
  for (const auto& line : grid) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      widths[i] = std::max(widths[i], width(line[i]));
    }
  }
  std::string text = heading_of(table) + " (" + kLegend + ")\n\n";
  for (std::size_t r = 0; r < grid.size(); ++r) {
    std::string line;
    for (std::size_t i = 0; i < grid[r].size(); ++i) {
      line += grid[r][i];
      if (i + 1 < grid[r].size()) {
        line += std::string(widths[i] - width(grid[r][i]) + 2, ' ');
      }
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
    if (r == 1) {
      std::string rule;
      for (std::size_t i = 0; i < widths.size(); ++i) {
        rule += std::string(widths[i], '-') + (i + 1 < widths.size() ? "  " : "");
      }
      text += rule + "\n";
    }
  }
  return text + notes_of(table);
}

std::string table_to_markdown(const Json& table) {
  const std::vector<std::vector<std::string>> grid = grid_of(table);
  std::string text = "**" + heading_of(table) + "** (" + kLegend + ")\n\n";
  const auto line = [&](const auto& cell) {
    text += "|";
    for (std::size_t i = 0; i < grid[0].size(); ++i) {
      text += " " + cell(i) + " |";
    }
    text += "\n";
  };
  line([&](std::size_t i) { return grid[0][i] + (grid[1][i].empty() ? "" : " [" + grid[1][i] + "]"); });
  line([](std::size_t) { return std::string("---"); });
  for (std::size_t r = 2; r < grid.size(); ++r) {
    line([&](std::size_t i) { return grid[r][i]; });
  }
  const std::string notes = notes_of(table);
  for (std::size_t start = 0; start < notes.size();) {
    const std::size_t end = notes.find('\n', start);
    text += (start == 0 ? "\n- " : "- ") + notes.substr(start + 2, end - start - 2) + "\n";
    start = end + 1;
  }
  return text;
}

}  // namespace driftlab
