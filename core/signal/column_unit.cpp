#include "core/signal/column_unit.hpp"

namespace driftlab {

Result<Unit> parse_unit(std::string_view symbol, Quantity quantity) {
  const bool force = quantity == Quantity::SpecificForce || quantity == Quantity::ReferenceSpecificForce;
  if (force && (symbol == "G" || symbol == "mG")) {
    return parse_unit(symbol == "G" ? "g" : "mg");
  }
  return parse_unit(quantity == Quantity::Temperature && symbol == "C" ? "degC" : symbol);
}

}  // namespace driftlab
