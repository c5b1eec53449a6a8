#include "schema/json/rounded.hpp"

#include <cmath>

namespace driftlab {

Json rounded(double value, int decimals) {
  double scale = 1.0;
  for (int i = 0; i < decimals; ++i) {
    scale *= 10.0;
  }
  return number(std::round(value * scale) / scale);
}

Json rounded_rows(const std::vector<double>& values, std::size_t columns, int decimals) {
  Json rows = Json::array();
  for (std::size_t first = 0; columns > 0 && first + columns <= values.size(); first += columns) {
    Json row = Json::array();
    for (std::size_t k = first; k < first + columns; ++k) {
      row.push_back(rounded(values[k], decimals));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace driftlab
