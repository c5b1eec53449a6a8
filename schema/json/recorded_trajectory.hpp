#pragma once
/// A recorded trajectory as a document: lists of one length.
///
/// `{"time_s": [...], "velocity_ned_m_s": [[north, east, down], ...], "roll_deg": [...], "pitch_deg": [...],
/// "heading_deg": [...]}`. Without angles the vehicle is taken to look where it goes: heading and pitch along the
/// velocity, kept while it is slower than 0.5 m/s, roll 0.
#include "core/navigate/outage_scenario.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Faults are added at `pointer` and below.
[[nodiscard]] RecordedTrajectory recorded_from_json(const Json& document, const std::string& pointer, Faults& faults);

[[nodiscard]] Json recorded_to_json(const std::vector<RecordedPose>& poses);

}  // namespace driftlab
