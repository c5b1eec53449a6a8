#pragma once
/// The calibration that a recording names in its metadata.
#include "core/analysis/recording_source.hpp"
#include "core/signal/recording.hpp"
#include "server/store/store.hpp"

namespace driftlab::server {

/// Empty where the recording names none. Errors: InvalidArgument (no such calibration, or one of another device).
[[nodiscard]] Result<Calibration> calibration_of(Store& store, const RecordingSpec& spec, std::string_view device_id);

}  // namespace driftlab::server
