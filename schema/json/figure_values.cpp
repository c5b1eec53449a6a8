#include "schema/json/figure_values.hpp"

#include "core/signal/significant.hpp"

namespace driftlab {

std::optional<double> value_of(const Json& value) {
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

Values values_of(const Json& list) {
  Values values;
  for (const Json& value : list) {
    values.push_back(value_of(value));
  }
  return values;
}

Values ends_of(const Json& intervals, std::size_t end) {
  Values values;
  for (const Json& interval : intervals) {
    values.push_back(interval.is_array() && interval.size() > end ? value_of(interval[end]) : std::nullopt);
  }
  return values;
}

std::vector<double> numbers_of(const Json& list) {
  std::vector<double> values;
  for (const Json& value : list) {
    values.push_back(value.is_number() ? value.get<double>() : 0.0);
  }
  return values;
}

std::string quantity_text(const Json& quantity) {
  const Json ci95 = quantity.value("ci95", Json(nullptr));
  const bool bounded = ci95.is_array() && ci95.size() == 2;
  return significant(quantity.at("value").get<double>(), bounded ? value_of(ci95[0]) : std::nullopt,
                     bounded ? value_of(ci95[1]) : std::nullopt) +
         " " + printed_unit(quantity.value("unit", ""));
}

std::string word(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.';
    out += plain ? std::string(1, c) : out.empty() || out.back() == '-' ? std::string() : std::string("-");
  }
  return out.empty() || out == "-" ? "figure" : out.back() == '-' ? out.substr(0, out.size() - 1) : out;
}

}  // namespace driftlab
