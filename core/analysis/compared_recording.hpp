#pragma once
/// What a regression run reads of a recording that was characterised in this process
/// (core/campaign/regression/recordings.hpp).
///
/// The same, to the bit, as what is read of its document (schema/json/compared_recording.hpp): a verdict does not
/// depend on whether its results were stored in between.
#include "core/analysis/characterise.hpp"
#include "core/campaign/regression/recordings.hpp"

namespace driftlab {

/// Session, time and causes are not of it; the temperature is, where a column states it. Figures that are not finite
/// are left out, or 0. O(channels x scales).
[[nodiscard]] regression::ComparedRecording compared_recording(const CharacterisedRecording& recording);

}  // namespace driftlab
