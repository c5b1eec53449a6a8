#pragma once
/// Tables with the names and units of the field in print (schema/figure/printed_names.hpp) in the place of those that
/// other programs ask by: for pages, not for a terminal whose reader types the names.
#include "core/campaign/parameter_table.hpp"
#include "core/campaign/trend_table.hpp"

namespace driftlab {

[[nodiscard]] ParameterTable in_print(ParameterTable table);
[[nodiscard]] TrendTable in_print(TrendTable table);

}  // namespace driftlab
