#include "schema/figure/printed_names.hpp"

#include <algorithm>

namespace driftlab {
namespace {

/// As the list has it; empty where it does not.
std::string listed(std::span<const PrintedName> names, std::string_view name) {
  const auto found =
      std::find_if(names.begin(), names.end(), [name](const PrintedName& one) { return one.name == name; });
  return found == names.end() ? std::string() : std::string(found->printed);
}

std::string spaced(std::string_view name) { return replaced(std::string(name), "_", " "); }

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

std::string process_name(std::string_view process) {
  const std::string known = listed(listed_processes(), process);
  return known.empty() ? spaced(process) : known;
}

std::string parameter_name(std::string_view parameter) {
  if (const std::string known = listed(listed_parameters(), parameter); !known.empty()) {
    return known;
  }
  for (const std::string_view unit : {"_hz", "_s", "_deg"}) {
    if (parameter.ends_with(unit)) {
      parameter.remove_suffix(unit.size());
      break;
    }
  }
  return spaced(parameter);
}

std::string column_name(std::string_view key) {
  const std::size_t dot = key.find('.');
  if (dot == std::string_view::npos) {
    return parameter_name(key);
  }
  std::string_view process = key.substr(0, dot);
  std::string number;
  // The how-manieth of its kind, where that is not a part of the kind's name.
  if (listed(listed_processes(), process).empty() && process.size() > 2 && is_digit(process.back()) &&
      process[process.size() - 2] == '_') {
    number = process.back() == '1' ? "" : std::string(" ") + process.back();
    process.remove_suffix(2);
  }
  return process_name(process) + number + " " + parameter_name(key.substr(dot + 1));
}

std::string printed_unit(std::string unit) {
  for (std::size_t at = unit.find("sqrt("); at != std::string::npos; at = unit.find("sqrt(")) {
    const std::size_t end = unit.find(')', at);
    unit = unit.substr(0, at) + "√" + unit.substr(at + 5, end - at - 5) +
           (end == std::string::npos ? "" : unit.substr(end + 1));
  }
  return replaced(replaced(std::move(unit), "^2", "²"), "*", "·");
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

}  // namespace driftlab
