#pragma once
/// Ends of profile-likelihood intervals.
#include <functional>

namespace driftlab::investigate {

/// Where 2 (top - l(x)) crosses `drop` on one side of `centre`: bracketed from `step` on, then by secant on its root.
[[nodiscard]] double profile_end(double centre, double step, double top, double drop, double limit,
                                 const std::function<double(double)>& log_likelihood);

}  // namespace driftlab::investigate
