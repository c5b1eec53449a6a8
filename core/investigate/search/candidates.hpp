#pragma once
/// The candidates of one round of the search in a channel group: the choice among them, and the rivals that the data
/// cannot distinguish from it.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace driftlab::investigate {

/// The candidate with the largest score; null for an empty list.
[[nodiscard]] const Evidence* strongest(const std::vector<Evidence>& candidates);

/// Keeps in `examined` the best evidence of every cause.
void keep_best(std::vector<Evidence>& examined, const std::vector<Evidence>& fresh);

/// Replaces in `remaining` the evidence of every cause that this round of the search looked for (`looked_for` is true)
/// by the best in `fresh`; a cause for which `fresh` holds nothing leaves the list. Evidence of the other causes stays.
void keep_last(std::vector<Evidence>& remaining, const std::vector<Evidence>& fresh,
               const std::function<bool(const Cause&)>& looked_for);

/// The strongest candidate beyond kThreshold, with those of its declared rivals that come within kMargin. A candidate
/// found at full rate is evaluated on samples to which it was not fitted; if its log likelihood gain there is negative,
/// its score is set to 0. Slow candidates are held out after the search has ended.
[[nodiscard]] std::optional<Evidence> choose(const FullRate& data, std::vector<Evidence>& candidates);

}  // namespace driftlab::investigate
