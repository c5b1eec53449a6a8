#pragma once
/// A profile without a name in words.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/unnamed/unnamed_effect.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// Where a profile is most sure to be above the model and below it, and how large it is there. `se`: of its values;
/// `unit`: of a mean.
[[nodiscard]] std::string sentence_of(const UnnamedEffect& effect, const std::vector<double>& se, const LabUnit& unit);

}  // namespace driftlab::investigate
