#pragma once
/// The use case "investigate": the recordings of a study in, what its baseline simulation gets wrong out.
///
/// Loads every recording onto its time grid, settles which channels are criticised, and runs the search
/// (core/investigate/investigate.hpp). Readings are examined as the sensor gave them: calibrations are not applied.
#include "core/analysis/recording_source.hpp"
#include "core/investigate/investigate.hpp"

#include <string>

namespace driftlab {

/// Grows whenever the same study could give another report.
inline constexpr int kInvestigationVersion = 7;

struct InvestigationRequest {
  std::string study;  ///< the name of the study, as the report gives it
  std::string device;
  investigate::Baseline baseline;  ///< the simulation to be criticised
  investigate::InvestigateOptions options;
};

/// Memory: the columns of every recording stay mapped until the report is made. Of each channel that has been searched
/// 9 bytes a sample are kept, to be compared with the others; the one that is being searched takes about fifty, or
/// eighty where its length is just above a power of two. Vibration is looked at sample by sample in up to a million of
/// them, which takes 480 bytes more for each. Errors: those of the source and of make_study_recording, located; those
/// of investigate::investigate; Cancelled.
[[nodiscard]] Result<investigate::Report> investigate_study(const InvestigationRequest& request,
                                                            RecordingSource& recordings,
                                                            const RunControl& control = {});

/// The report as a Markdown page for people.
[[nodiscard]] std::string investigation_page(const investigate::Report& report);

}  // namespace driftlab
