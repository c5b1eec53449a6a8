#pragma once
/// One simulated experiment: a drive, an inertial unit, a receiver with outages, and the filters that are compared.
#include "core/navigate/imu_simulator.hpp"
#include "core/navigate/look_ahead.hpp"
#include "core/navigate/navigation_filter.hpp"
#include "core/navigate/recorded_motion.hpp"
#include "core/navigate/segment_motion.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace driftlab {

struct FilterCandidate {
  std::string name;
  std::string about;  ///< what it believes, in words
  FilterSettings settings;
};

struct OutageScenario {
  std::string name;
  std::string about;
  SegmentPlan drive;
  /// If it is not empty, the vehicle follows these poses instead of the segments of `drive`. It begins at the place
  /// where `drive` starts and goes on to the last pose; `drive.duration_s` must not exceed the duration of the poses.
  std::vector<RecordedPose> recorded;
  double imu_rate_hz = 100.0;
  ImuModel truth;
  ImuHardware hardware;
  GnssModel gnss;
  std::vector<Outage> outages;
  /// The first estimate is the truth plus a draw of these; every filter starts from the same one.
  InitialUncertainty initial;
  std::vector<FilterCandidate> filters;
};

inline constexpr std::size_t kMostOutages = 1000;

/// A scenario as its document has it. Beside the members of OutageScenario a document may name a recorded trajectory,
/// for the poses and the duration of the drive, and ask for outages over turns; `completed` works these out.
struct WrittenScenario {
  OutageScenario scenario;  ///< `drive.duration_s` of 0 stands for the duration of `recorded`
  RecordedTrajectory recorded;
  std::optional<double> at_turns_s;  ///< an outage of this duration over each turn of the drive, beside those listed
};

/// The scenario with its poses, its duration and every outage. Pitch and heading that the recorded trajectory does not
/// have become those of the velocity (look_ahead.hpp). An outage over a turn begins with the turn; these outages come
/// after the listed ones, in the order of the segments.
[[nodiscard]] OutageScenario completed(WrittenScenario written);

/// The motion of the scenario. Errors: those of make_segment_motion and make_recorded_motion; InvalidArgument (the
/// drive lasts longer than the poses).
[[nodiscard]] Result<std::unique_ptr<Motion>> make_motion(const OutageScenario& scenario);

/// Errors: InvalidArgument (no filter or two of one name, no outage or more than kMostOutages, outages that overlap,
/// begin before the first fix or end after the drive), LimitExceeded (more than 10 million samples), and those of the
/// parts. An error of make_motion has the field "segment" if it concerns a segment; one of FilterDesign::check has the
/// field "filter".
[[nodiscard]] Status check(const OutageScenario& scenario);

}  // namespace driftlab
