#pragma once
/// Whether the bias moved with the change (spec/regression.md, section 7).
///
/// The mean of a sensor axis at rest is its bias and what the axis truly saw; of it a session has one. How much it
/// moves from one power-up to the next has no prior, for that differs by orders between sensors, so that a bias is
/// tested only with a margin and three sessions an arm, and is told otherwise. The test is Welch's (1947), Biometrika
/// 34, 28: with d the difference of the arms' means of session means and se^2 = s_1^2/n + s_2^2/m, more than the margin
/// is shown where P(T > (|d| - margin)/se), T Student's with the degrees of freedom of Welch and Satterthwaite, times
/// the number of units (Bonferroni; for the smallest p it is Holm) is at most the level.
#include "core/campaign/regression/event_checks.hpp"

namespace driftlab::regression {

/// Entry `bias`: fail where more than the margin is shown; note where a margin cannot be tested for want of sessions;
/// else fine, with a sentence on the largest move. `level`: of this test in this look.
[[nodiscard]] EventCheck check_bias(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                                    const BiasMargins& margins, double level);

}  // namespace driftlab::regression
