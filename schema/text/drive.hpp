#pragma once
/// A recorded drive as text for people: the facts of its files, and the filter's errors in its outages.
#include "core/analysis/drive.hpp"

#include <string>

namespace driftlab {

/// Facts of the files, no filter.
[[nodiscard]] std::string drive_check_to_text(const DriveCheck& checked);

/// One sentence, then a table of durations, classes, innovations and notes.
[[nodiscard]] std::string drive_report_to_text(const DriveReport& report);

/// "0.1265 +- 0.0009 s". A value that has no error is given without, and a ratio without a unit.
[[nodiscard]] std::string size_of_finding(const drive::DriveFinding& finding);

/// One sentence, then findings and the table of rungs.
[[nodiscard]] std::string drive_explanation_to_text(const DriveExplanationReport& report);

/// One sentence, then measured beside simulated outages.
[[nodiscard]] std::string drive_simulation_to_text(const DriveSimulationReport& simulation);

/// A sentence for each duration, then the filters and their differences pair by pair.
[[nodiscard]] std::string drive_comparison_to_text(const DriveComparisonReport& report);

/// Whichever of these it is.
[[nodiscard]] std::string drive_answer_to_text(const DriveAnswer& answer);

/// The drive in a line: name, vehicle, duration, length, highest speed.
[[nodiscard]] std::string header_of_drive(const drive::Drive& drive);

/// The facts of a drive, one line each; empty if there are none.
[[nodiscard]] std::string notes_of_drive(const std::vector<std::string>& notes);

/// The rows of a table of durations: n, rms with interval, median, NEES, coverage.
[[nodiscard]] std::string duration_rows(const std::vector<drive::DurationSummary>& durations);

}  // namespace driftlab
