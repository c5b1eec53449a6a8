#pragma once
/// The candidates of one round of the search in a channel group: the choice among them, and the rivals that the data
/// cannot distinguish from it.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace driftlab::investigate {

/// The one of the largest score; null where there is none.
[[nodiscard]] const Evidence* strongest(const std::vector<Evidence>& candidates);

/// Keeps in `examined` the best evidence of every cause.
void keep_best(std::vector<Evidence>& examined, const std::vector<Evidence>& fresh);

/// Keeps in `remaining` the best evidence of every cause as the last look saw it. `looked_for`: the causes of this
/// look; one of them of which it saw nothing has gone.
void keep_last(std::vector<Evidence>& remaining, const std::vector<Evidence>& fresh,
               const std::function<bool(const Cause&)>& looked_for);

/// The strongest candidate beyond kThreshold, with those of its declared rivals that come within kMargin. Candidates
/// found at full rate are evaluated on samples to which they were not fitted, and their score is 0 if they are worse
/// than nothing there. Slow ones are held out once the search has ended.
[[nodiscard]] std::optional<Evidence> choose(const FullRate& data, std::vector<Evidence>& candidates);

}  // namespace driftlab::investigate
