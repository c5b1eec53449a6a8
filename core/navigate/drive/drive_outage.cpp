#include "core/navigate/drive/drive_outage.hpp"

#include "core/navigate/earth.hpp"
#include "core/signal/angle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace driftlab::drive {
namespace {

/// Of the point that the estimate is compared with, in north, east and down [m^2].
Vector3 reference_variance(const Drive& drive, const ColouredFixes& coloured, double time_s) {
  const auto after = std::lower_bound(drive.fixes.begin(), drive.fixes.end(), time_s,
                                      [](const Fix& fix, double t) { return fix.time_s < t; });
  if (drive.withheld_fixes && after != drive.fixes.end()) {
    return after->position_sd_m.cwiseAbs2() +
           (coloured.none() ? Vector3(Vector3::Zero()) : Vector3(coloured.sd_m().cwiseAbs2()));
  }
  return Vector3::Constant(drive.document.reference.sd_m * drive.document.reference.sd_m);
}

/// What the vehicle does in the outage, and how the error lies to its way.
void classify(const Drive& drive, double end_s, const Matrix3& axes, DriveOutage& scored) {
  const auto ahead = reference_at(drive.reference, end_s + 0.5);
  const auto behind = reference_at(drive.reference, end_s - 0.5);
  Vector3 way = Vector3::Zero();
  if (ahead && behind) {
    way = axes.transpose() * (*ahead - *behind);
  }
  const double length = way.head<2>().norm();
  const double x = length > 0.25 ? way.x() / length : 1.0;
  const double y = length > 0.25 ? way.y() / length : 0.0;
  scored.along_m = x * scored.error_ned_m.x() + y * scored.error_ned_m.y();
  scored.across_m = x * scored.error_ned_m.y() - y * scored.error_ned_m.x();
  double longest = 0.0;
  double turned = 0.0;
  double most = 0.0;
  double before = 0.0;
  const double from = scored.outage.start_s;
  const auto seconds = static_cast<int>(scored.outage.duration_s);
  bool moving_before = false;
  for (int s = 0; s < seconds; ++s) {
    const auto a = reference_at(drive.reference, from + s);
    const auto b = reference_at(drive.reference, from + s + 1.0);
    if (!a || !b) {
      continue;
    }
    const Vector3 step = axes.transpose() * (*b - *a);
    const double speed = step.head<2>().norm();
    longest = std::max(longest, speed);
    if (speed > 1.0) {
      const double course = std::atan2(step.y(), step.x());
      if (moving_before) {
        turned += std::remainder(course - before, 2.0 * std::numbers::pi);
        most = std::max(most, std::abs(turned));
      }
      before = course;
      moving_before = true;
    }
  }
  scored.outage_class = longest < kRestSpeed    ? OutageClass::Rest
                        : most < 20.0 * kDegree ? OutageClass::Straight
                                                : OutageClass::Turning;
}

/// From the unit to the point that the reference describes, in body axes.
Vector3 arm_of(const Drive& drive, const OutageMoment& at) {
  return drive.withheld_fixes ? at.lever_arm_m : drive.document.reference.lever_arm_m;
}

}  // namespace

std::optional<Vector3> antenna_error(const Drive& drive, const OutageMoment& at) {
  const auto truth = reference_at(drive.reference, at.time_s);
  if (!truth) {
    return std::nullopt;
  }
  const Vector3 turned = at.attitude * arm_of(drive, at);
  return Vector3(ned_axes(*truth).transpose() * (at.state.position_ecef_m + turned - *truth));
}

std::optional<DriveOutage> score_outage(const Drive& drive, const FilterOptions& options, const Outage& outage,
                                        const OutageStart& start, const OutageEnd& end) {
  const double end_s = end.at.time_s;
  const auto truth = reference_at(drive.reference, end_s);
  const auto at_start = reference_at(drive.reference, start.time_s);
  const auto error = antenna_error(drive, end.at);
  if (!truth || !at_start || !error) {
    return std::nullopt;
  }
  DriveOutage scored;
  scored.outage = outage;
  scored.reference_ecef_m = *truth;
  const Matrix3 axes = ned_axes(*truth);
  const Vector3 arm = arm_of(drive, end.at);
  const Vector3 turned = end.at.attitude * arm;
  scored.error_ned_m = *error;
  scored.growth_m = start.growth_m;
  scored.growth_m.push_back(scored.error_m());
  Eigen::Matrix<double, 3, 9> h = Eigen::Matrix<double, 3, 9>::Zero();
  h.block<3, 3>(0, 0).setIdentity();
  h.block<3, 3>(0, 6) = -cross_matrix(turned);
  const Matrix3 p = h * end.covariance * h.transpose();
  scored.covariance_ned = axes.transpose() * p * axes;
  scored.covariance_ned.diagonal() += reference_variance(drive, options.coloured, end_s);
  scored.heading_sd_rad = end.heading_sd_rad;
  const Vector3 start_arm = start.state.attitude * arm;
  const Vector3 before = axes.transpose() * (start.state.position_ecef_m + start_arm - *at_start);
  scored.start_error_m = before.head<2>().norm();
  const Vector3 straight = axes.transpose() * (start.state.position_ecef_m + start_arm +
                                               (end.at.time_s - start.time_s) * start.state.velocity_ecef_m_s - *truth);
  scored.straight_line_error_m = straight.head<2>().norm();
  classify(drive, end_s, axes, scored);
  return scored;
}

std::string_view name_of(OutageClass outage_class) {
  constexpr std::array<std::string_view, 3> kNames{"rest", "straight", "turning"};
  return kNames[static_cast<std::size_t>(outage_class)];
}

double DriveOutage::nees() const {
  const Matrix3& p = covariance_ned;
  const double n = error_ned_m.x();
  const double e = error_ned_m.y();
  const double cross = 0.5 * (p(0, 1) + p(1, 0));
  return (p(1, 1) * n * n - 2.0 * cross * n * e + p(0, 0) * e * e) / (p(0, 0) * p(1, 1) - cross * cross);
}

std::optional<Vector3> reference_at(const std::vector<ReferencePoint>& reference, double time_s) {
  const auto after = std::lower_bound(reference.begin(), reference.end(), time_s,
                                      [](const ReferencePoint& point, double t) { return point.time_s < t; });
  if (after == reference.begin() || after == reference.end()) {
    return std::nullopt;
  }
  const auto before = after - 1;
  if (time_s - before->time_s > kNearestReference || after->time_s - time_s > kNearestReference) {
    return std::nullopt;
  }
  const double u = (time_s - before->time_s) / (after->time_s - before->time_s);
  return Vector3((1.0 - u) * before->position_ecef_m + u * after->position_ecef_m);
}

}  // namespace driftlab::drive
