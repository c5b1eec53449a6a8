#pragma once
/// The unit of a column of which it is known what it measures.
#include "core/signal/quantity.hpp"

#include <string_view>

namespace driftlab {

/// parse_unit for a column of `quantity`, which tells what a letter stands for that alone may mean anything: of a
/// specific force `G` is g and no gauss, of a temperature `C` is degC. Errors: those of parse_unit.
[[nodiscard]] Result<Unit> parse_unit(std::string_view symbol, Quantity quantity);

}  // namespace driftlab
