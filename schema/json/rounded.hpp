#pragma once
/// Numbers of long lists, which need no more digits than anybody can use.
#include "schema/json/json.hpp"

#include <cstddef>
#include <vector>

namespace driftlab {

/// The number to so many decimals, 0 to 9, halves away from zero; null where it is not finite.
[[nodiscard]] Json rounded(double value, int decimals);

/// The same of a table that is stored row by row, `columns` in a row: one list per row.
[[nodiscard]] Json rounded_rows(const std::vector<double>& values, std::size_t columns, int decimals);

}  // namespace driftlab
