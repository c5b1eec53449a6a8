#pragma once
/// Numbers of long lists, which need no more digits than anybody can use.
#include "schema/json/json.hpp"

namespace driftlab {

/// The number to so many decimals, 0 to 9, halves away from zero; null where it is not finite.
[[nodiscard]] Json rounded(double value, int decimals);

}  // namespace driftlab
