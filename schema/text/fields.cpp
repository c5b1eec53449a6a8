#include "schema/text/fields.hpp"

namespace driftlab {

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

std::string markdown_field(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<' || c == '>') {
      result += c == '<' ? "&lt;" : "&gt;";
    } else if (c == '|' || c == '`' || c == '[' || c == ']') {
      result += std::string("\\") + c;
    } else {
      result += c == '\n' || c == '\r' ? ' ' : c;
    }
  }
  return result;
}

}  // namespace driftlab
