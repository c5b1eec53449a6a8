#pragma once
/// What the two breaks of a clock have in common as causes (core/investigate/consistency/reference_clock.hpp).
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/family.hpp"
#include "core/investigate/causes/showing.hpp"
#include "core/investigate/consistency/reference_clock.hpp"

#include <span>
#include <string>
#include <vector>

namespace driftlab::investigate {

/// The breaks of one kind in all recordings, one fault each; the size is reported as `parameter`.
[[nodiscard]] std::vector<FaultyRecordings> clock_faults(const Study& study, ClockBreak kind,
                                                         const std::string& parameter, const LabUnit& unit,
                                                         const std::stop_token& stop);

/// Adds the effect of a break to the mean of a draft: the rate at the times of the broken clock less the rate at the
/// right ones. `values` are size and t0.
void inject_clock_break(Draft& draft, ClockBreak kind, std::span<const double> values);

/// Size and time of a break in the middle of the second recording, of the size that stands out at about 1.5 times
/// `stage.z` standard deviations.
[[nodiscard]] std::vector<double> shown_clock_break(const Stage& stage, ClockBreak kind);

}  // namespace driftlab::investigate
