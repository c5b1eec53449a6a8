#pragma once
/// A GNSS receiver as a loosely coupled filter sees it: fixes of position and velocity at a steady rate.
///
/// A fix describes the antenna at its time of validity and arrives `latency_s` later. Its errors are north, east, down:
/// white ones, and a first-order Gauss-Markov position error where the receiver has one. During an outage
/// [start, start + duration) no fix arrives: one that is due at the very start is lost, one at the end is the first to
/// return.
#include "core/navigate/trajectory.hpp"
#include "core/process/random.hpp"

#include <optional>
#include <vector>

namespace driftlab {

struct GnssModel {
  double rate_hz = 1.0;
  Vector3 position_sd_m{2.5, 2.5, 4.0};  ///< north, east, down
  Vector3 velocity_sd_m_s{0.1, 0.1, 0.2};
  Vector3 correlated_sd_m = Vector3::Zero();  ///< Gauss-Markov position error beside the white one
  double correlation_time_s = 0.0;
  double latency_s = 0.0;
  Vector3 lever_arm_m = Vector3::Zero();  ///< from the inertial unit to the antenna, body axes
};

struct GnssFix {
  double arrival_s = 0.0;   ///< when the filter gets it
  double validity_s = 0.0;  ///< what moment it describes
  Vector3 position_ecef_m = Vector3::Zero();
  std::optional<Vector3> velocity_ecef_m_s;
  Vector3 position_sd_m = Vector3::Ones();  ///< north, east, down, as the receiver states them
  Vector3 velocity_sd_m_s = Vector3::Ones();
};

struct Outage {
  double start_s = 0.0;
  double duration_s = 0.0;
  [[nodiscard]] double end_s() const { return start_s + duration_s; }
  [[nodiscard]] bool covers(double time_s) const { return time_s >= start_s - 1e-9 && time_s < end_s() - 1e-9; }
};

/// Errors: InvalidArgument naming the member.
[[nodiscard]] Status check(const GnssModel& model);

/// Fixes at every whole period after time 0, without those in outages. Between two samples of the trajectory the state
/// is taken from the nearer one and extrapolated with its velocity. Random numbers are drawn for lost fixes too, so
/// that an outage changes no other fix.
[[nodiscard]] std::vector<GnssFix> simulate_gnss(const Trajectory& trajectory, const GnssModel& model,
                                                 const std::vector<Outage>& outages, Random& random);

}  // namespace driftlab
