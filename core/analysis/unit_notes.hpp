#pragma once
/// What speaks against the units of a recording, said where it is uploaded and where it is characterised.
#include "core/read/column_file.hpp"
#include "core/signal/recording_view.hpp"

#include <span>
#include <string>

namespace driftlab {

/// Adds sentences (core/datasheet/plausible_units.hpp) about the inertial channels of `view`, which may be one of a
/// survey, to the notes of its quality.
/// At most the first 200 000 samples of the longest run without a gap are looked at. A recording that names a
/// calibration is passed over: what its columns mean is said there. `hardware`: texts that describe the device, most
/// telling first.
void add_unit_notes(RecordingView& view, const ColumnFile& columns, const RecordingSpec& spec,
                    std::span<const std::string> hardware);

}  // namespace driftlab
