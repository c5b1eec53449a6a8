#include "core/navigate/recorded_drive.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

Status check(const RecordedDrive& drive, const std::vector<Outage>& outages) {
  if (drive.readings.empty() || drive.fixes.empty() || drive.reference.size() < 2) {
    return fail(ErrorCode::TooFewSamples, "A recorded drive needs readings, fixes and a reference.");
  }
  const bool ordered =
      std::is_sorted(drive.fixes.begin(), drive.fixes.end(),
                     [](const GnssFix& a, const GnssFix& b) { return a.arrival_s < b.arrival_s; }) &&
      std::is_sorted(drive.reference.begin(), drive.reference.end(),
                     [](const ReferencePoint& a, const ReferencePoint& b) { return a.time_s < b.time_s; });
  if (!ordered) {
    return fail(ErrorCode::NonMonotonicTime, "Fixes and reference of a recorded drive are ordered in time.");
  }
  const double end = drive.start_s + static_cast<double>(drive.readings.size()) * drive.dt_s;
  double before = drive.start_s;
  for (const Outage& outage : outages) {
    if (!(outage.duration_s > 0.0 && outage.start_s > before && outage.end_s() <= end &&
          outage.start_s >= drive.reference.front().time_s && outage.end_s() <= drive.reference.back().time_s)) {
      return fail(ErrorCode::InvalidArgument, "Outages lie one after the other within the drive and its reference.",
                  {{"parameter", "outages"}});
    }
    before = outage.end_s();
  }
  return {};
}

Vector3 reference_at(const std::vector<ReferencePoint>& reference, double time_s) {
  const auto after = std::lower_bound(reference.begin() + 1, reference.end() - 1, time_s,
                                      [](const ReferencePoint& p, double t) { return p.time_s < t; });
  const auto before = after - 1;
  const double u = (time_s - before->time_s) / (after->time_s - before->time_s);
  return (1.0 - u) * before->position_ecef_m + u * after->position_ecef_m;
}

RecordedOutage score(NavigationFilter& filter, const NavigationState& at_start, const RecordedDrive& drive,
                     const Outage& outage, double now_s) {
  const Vector3 truth = reference_at(drive.reference, now_s);
  const Matrix3 axes = ned_axes(truth);
  const Vector3 error = axes.transpose() * (filter.state().position_ecef_m - truth);
  const Matrix3 p = axes.transpose() * filter.covariance().navigation().block<3, 3>(0, 0) * axes;
  const double determinant = p(0, 0) * p(1, 1) - p(0, 1) * p(1, 0);
  RecordedOutage result;
  result.outage = outage;
  result.north_m = error.x();
  result.east_m = error.y();
  result.error_m = std::hypot(error.x(), error.y());
  result.nees =
      (p(1, 1) * error.x() * error.x() - 2.0 * p(0, 1) * error.x() * error.y() + p(0, 0) * error.y() * error.y()) /
      determinant;
  const Vector3 before =
      axes.transpose() * (at_start.position_ecef_m - reference_at(drive.reference, now_s - outage.duration_s));
  result.start_error_m = std::hypot(before.x(), before.y());
  const Vector3 straight =
      axes.transpose() * (at_start.position_ecef_m + outage.duration_s * at_start.velocity_ecef_m_s - truth);
  result.straight_line_error_m = std::hypot(straight.x(), straight.y());
  return result;
}

}  // namespace

Result<std::vector<RecordedOutage>> evaluate_recorded(const RecordedDrive& drive, const FilterDesign& design,
                                                      const NavigationState& start,
                                                      const std::vector<Outage>& outages) {
  if (auto status = check(drive, outages); !status) {
    return fail(status.error());
  }
  NavigationFilter filter(design, start);
  std::vector<RecordedOutage> results;
  NavigationState at_start = start;
  std::size_t fix = 0;
  std::size_t outage = 0;
  bool inside = false;
  for (std::size_t i = 0; i < drive.readings.size(); ++i) {
    filter.advance(std::span(drive.readings).subspan(i, 1));
    const double now = drive.start_s + static_cast<double>(i + 1) * drive.dt_s;
    if (outage < outages.size() && !inside && now >= outages[outage].start_s) {
      inside = true;
      at_start = filter.state();
    }
    if (inside && now >= outages[outage].end_s() - 1e-9) {
      results.push_back(score(filter, at_start, drive, outages[outage], now));
      inside = false;
      ++outage;
    }
    for (; fix < drive.fixes.size() && drive.fixes[fix].arrival_s <= now; ++fix) {
      if (!inside && drive.fixes[fix].arrival_s > now - 1.0) {  // fixes from before the first reading are left out
        filter.update(drive.fixes[fix]);
      }
    }
  }
  return results;
}

Quaternion level_attitude(std::span<const ImuSample> readings, const Vector3& position_ecef_m, double heading_rad) {
  Vector3 force = Vector3::Zero();
  for (const ImuSample& sample : readings) {
    force += Vector3(sample[3], sample[4], sample[5]);
  }
  // At rest the specific force is (g sin pitch, -g sin roll cos pitch, -g cos roll cos pitch).
  EulerAngles angles;
  angles.roll_rad = std::atan2(-force.y(), -force.z());
  angles.pitch_rad = std::atan2(force.x(), std::hypot(force.y(), force.z()));
  angles.heading_rad = heading_rad;
  return Quaternion(ned_axes(position_ecef_m)) * from_euler(angles);
}

}  // namespace driftlab
