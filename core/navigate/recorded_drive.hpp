#pragma once
/// The navigation filter on recorded data: a real inertial unit, real fixes, artificial outages, and a reference for
/// scoring.
///
/// Fixes inside an outage are withheld. At its end, before the first returning fix, the estimate is compared with the
/// reference, which is interpolated linearly in time. The same is done for the simplest alternative: the filter's
/// position and velocity at the start of the outage, extrapolated in a straight line.
///
/// Readings and fixes must share one clock. A clock offset of seconds causes errors of metres after an outage and shows
/// as a NEES far above 2; core/calibrate/time_alignment.hpp finds the delay from the turns in both.
#include "core/navigate/navigation_filter.hpp"

#include <vector>

namespace driftlab {

struct ReferencePoint {
  double time_s = 0.0;
  Vector3 position_ecef_m = Vector3::Zero();
};

/// Readings are uniform: readings[i] is the mean over the interval that ends at start_s + (i + 1) dt_s.
struct RecordedDrive {
  double start_s = 0.0;
  double dt_s = 0.01;
  std::vector<ImuSample> readings;
  std::vector<GnssFix> fixes;             ///< by arrival
  std::vector<ReferencePoint> reference;  ///< by time
};

struct RecordedOutage {
  Outage outage;
  double north_m = 0.0, east_m = 0.0;  ///< estimate minus reference
  double nees = 0.0;                   ///< two dimensions; counts the reference's own error too
  double error_m = 0.0;
  double start_error_m = 0.0;          ///< of the estimate at the start of the outage
  double straight_line_error_m = 0.0;  ///< of the straight-line extrapolation
};

/// Errors: TooFewSamples (no readings, fixes or reference), NonMonotonicTime (fixes or reference), InvalidArgument (an
/// outage that does not lie within readings and reference).
[[nodiscard]] Result<std::vector<RecordedOutage>> evaluate_recorded(const RecordedDrive& drive,
                                                                    const FilterDesign& design,
                                                                    const NavigationState& start,
                                                                    const std::vector<Outage>& outages);

/// Attitude of a unit at rest or in uniform motion: roll and pitch from the direction of the mean specific force of
/// `readings`, heading as given. The tilt error is the acceleration of the vehicle over gravity.
[[nodiscard]] Quaternion level_attitude(std::span<const ImuSample> readings, const Vector3& position_ecef_m,
                                        double heading_rad);

}  // namespace driftlab
