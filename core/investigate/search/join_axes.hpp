#pragma once
/// Findings on several axes that have one common value are joined into one finding.
#include "core/investigate/causes/evidence.hpp"

#include <vector>

namespace driftlab::investigate {

/// Joins what was found of a cause on several channel groups where the cause declares that one value moves them all
/// (MeanEffect::one_for_all_axes). The first parameter becomes the mean weighted by the inverse squares of the
/// intervals' widths, with the interval of that mean; scores, gains, held-out gains and held-out samples add up, for
/// the channels' noise is independent. The first finding stays, `also_groups` names the groups of the others.
void join_axes(std::vector<Evidence>& found);

}  // namespace driftlab::investigate
