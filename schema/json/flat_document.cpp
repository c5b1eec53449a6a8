#include "schema/json/flat_document.hpp"

namespace driftlab {
namespace {

/// In quotes where it must be.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) {
    return text;
  }
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  }
  return quoted + "\"";
}

void write_value(std::string& csv, const std::string& path, const std::string& index, const Json& value) {
  csv += cell(path) + "," + index + ",";
  if (value.is_number()) {
    csv += to_text(value) + ",";
  } else if (!value.is_null()) {
    csv += "," + cell(value.is_string() ? value.get<std::string>() : to_text(value));
  } else {
    csv += ",";
  }
  csv += "\n";
}

void walk(std::string& csv, const std::string& path, const Json& node) {
  const std::string begin = path.empty() ? "" : path + ".";
  if (node.is_object()) {
    for (const auto& [name, value] : node.items()) {
      walk(csv, begin + name, value);
    }
  } else if (node.is_array()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      if (node[i].is_structured()) {
        walk(csv, begin + std::to_string(i), node[i]);
      } else {
        write_value(csv, path, std::to_string(i + 1), node[i]);
      }
    }
  } else {
    write_value(csv, path, "", node);
  }
}

}  // namespace

std::string flat_csv(const Json& document) {
  std::string csv = "path,index,number,text\n";
  walk(csv, "", document);
  return csv;
}

}  // namespace driftlab
