#pragma once
/// The candidates of one look at a channel group: which is taken, and what cannot be told from it.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <optional>
#include <vector>

namespace driftlab::investigate {

/// The one of the largest score; null where there is none.
[[nodiscard]] const Evidence* strongest(const std::vector<Evidence>& candidates);

/// Keeps in `examined` the best evidence of every cause.
void keep_best(std::vector<Evidence>& examined, const std::vector<Evidence>& fresh);

/// The strongest candidate beyond kThreshold, with its declared rivals that come within kMargin. Those seen at full
/// rate are tried on samples they were not fitted to and go where they are worse than nothing there; slow ones are held
/// out once the search has ended.
[[nodiscard]] std::optional<Evidence> choose(const FullRate& data, std::vector<Evidence>& candidates);

}  // namespace driftlab::investigate
