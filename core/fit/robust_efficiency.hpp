#pragma once
/// The efficiency of a channel's robust variances relative to the classical ones.
#include "core/fit/characterisation.hpp"

#include <optional>

namespace driftlab {

/// The mean efficiency of the robust variances over the scales that have one; nothing where none has.
[[nodiscard]] std::optional<double> mean_robust_efficiency(const HaarCurve& curve);

}  // namespace driftlab
