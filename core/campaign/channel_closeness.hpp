#pragma once
/// Which of a channel's fitted models are the closest to its data (core/fit/closeness.hpp).
#include "core/campaign/reported_channel.hpp"

#include <optional>
#include <vector>

namespace driftlab {

/// For each fit of the channel, L + 2p above the least of all; 0 is the closest, and up to 6 are plausible.
[[nodiscard]] std::vector<std::optional<double>> distances_2p(const ReportedChannel& channel);

}  // namespace driftlab
