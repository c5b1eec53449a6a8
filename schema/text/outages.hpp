#pragma once
/// Simulated outages for people.
#include "core/analysis/evaluate_outages.hpp"

#include <string>

namespace driftlab {

/// The verdict, then as aligned columns: filters by outage, paired differences, where the gain comes from, the claims
/// of the paper. Errors [m], angles [deg], 95 % intervals in brackets.
[[nodiscard]] std::string outage_text(const OutageReport& report);

}  // namespace driftlab
