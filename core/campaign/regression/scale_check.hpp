#pragma once
/// Whether the scale factor moved with the change (spec/regression.md, section 7).
///
/// Where a session has recordings of an axis under two known true values or more, the line through their means has the
/// slope 1 + S and the bias as its offset (core/calibrate/triad.hpp): S is the session's figure, by least squares
/// weighted by samples, and is compared as session_means.hpp says. A gyroscope axis is known at rest (0) and under
/// `constant_rate` about it, an accelerometer axis with `six_position` up and down (+g, -g). Standard gravity is used
/// in place of the local one; the difference cancels between arms recorded at one place.
#include "core/campaign/regression/event_checks.hpp"

namespace driftlab::regression {

/// Entry `scale_factor`, as check_shift says. `level`: of this test in this look.
[[nodiscard]] EventCheck check_scale_factor(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                                            const ScaleMargins& margins, double level);

}  // namespace driftlab::regression
