#pragma once
/// In which order the releases of a comparison stand (spec/regression.md, section 8).
#include "core/campaign/regression/compared_sessions.hpp"
#include "core/campaign/regression/release_trend.hpp"

namespace driftlab::regression {

/// Baseline, candidate and earlier releases in the order of time where every recording has one; else the candidate
/// last, and the baseline where the request says that it came. Equal times share a position.
[[nodiscard]] ReleaseOrder order_of(const Request& request, const ComparedSessions& sessions);

}  // namespace driftlab::regression
