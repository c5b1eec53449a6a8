#pragma once
/// Does the change look like a change of the sampling clock's rate? Internal to core/campaign/regression.
#include "core/campaign/regression/report.hpp"

#include <vector>

namespace driftlab::regression {

/// A note where the scales to `through_s` of three axes or more all move by one factor, by 3 to 12 %: so does a clock
/// that is off, whose error d moves a white density by d/2. Nothing where the samples are stamped in both arms, for
/// their clock is known. Never fails.
[[nodiscard]] EventCheck check_time_base(const std::vector<UnitReport>& units, double through_s, bool stamped);

}  // namespace driftlab::regression
