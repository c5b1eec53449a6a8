#pragma once
/// A calibration as lines for people.
#include "core/analysis/calibrate.hpp"

#include <string>

namespace driftlab {

/// Every sensor under a line that says what it was calibrated from: each axis with bias and scale, +- half the 95 %
/// interval, how the axes lie to each other, the residual, and the notes. What has no interval, or is no result of the
/// readings at all, is followed by a sentence that says why.
[[nodiscard]] std::string calibration_to_text(const CalibrationReport& report);

}  // namespace driftlab
