#pragma once
/// Whether the bias moved with the change (spec/regression.md, section 7).
///
/// The mean of a sensor axis at rest is its bias plus the true input of the axis. Each session has one such mean, and
/// the means are compared as in session_means.hpp. Recordings in motion are left out, because their mean depends on the
/// scale factor too (scale_check.hpp).
#include "core/campaign/regression/event_checks.hpp"

namespace driftlab::regression {

/// Entry `bias`, as check_shift says. `level`: of this test in this look.
[[nodiscard]] EventCheck check_bias(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                                    const BiasMargins& margins, double level);

}  // namespace driftlab::regression
