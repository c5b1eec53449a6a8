/// What the sources of a drive say of the same motion, compared: units and signs that cannot be right are refused with
/// the repair.
#include "core/navigate/drive/drive.hpp"
#include "core/signal/angle.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

constexpr double kSwapped = 0.9;  ///< correlation of displacements and velocities with their axes exchanged

// Of forces with the changes of speed and the turns that the fixes show. Chosen, not measured: a sound drive has 0.6
// and more, slopes and late velocities take from it.
constexpr double kMirrored = -0.5;
constexpr double kExchanged = 0.6;
constexpr std::size_t kEnoughIntervals = 50;
constexpr double kWindow = 1.0;       ///< [s] and more: velocities are late by some tenths, and noisy
constexpr double kEnoughForce = 0.4;  ///< [m/s^2], rms

tl::unexpected<Error> implausible(const char* member, std::string sentence) {
  return fail(ErrorCode::InvalidArgument, std::move(sentence), {{"parameter", member}});
}

/// Running correlation of two quantities without their means taken off.
struct Product {
  double xy = 0.0, xx = 0.0, yy = 0.0;
  std::size_t count = 0;
  void add(double x, double y) {
    xy += x * y;
    xx += x * x;
    yy += y * y;
    ++count;
  }
  [[nodiscard]] double correlation() const { return xx > 0.0 && yy > 0.0 ? xy / std::sqrt(xx * yy) : 0.0; }
};

struct MeanReading {
  Vector3 rate = Vector3::Zero(), force = Vector3::Zero();
};

/// Mean readings over [from, to]; nothing outside the readings.
std::optional<MeanReading> mean_reading(const std::vector<UniformRun>& runs, double from_s, double to_s) {
  for (const UniformRun& run : runs) {
    if (from_s < run.start_s || to_s > run.end_s()) {
      continue;
    }
    const auto first = static_cast<std::size_t>((from_s - run.start_s) / run.dt_s);
    const auto last = std::min(static_cast<std::size_t>((to_s - run.start_s) / run.dt_s), run.readings.size());
    if (last <= first) {
      return std::nullopt;
    }
    MeanReading mean;
    for (std::size_t i = first; i < last; ++i) {
      const ImuSample& sample = run.readings[i];
      mean.rate += Vector3(sample[0], sample[1], sample[2]);
      mean.force += Vector3(sample[3], sample[4], sample[5]);
    }
    mean.rate /= static_cast<double>(last - first);
    mean.force /= static_cast<double>(last - first);
    return mean;
  }
  return std::nullopt;
}

/// Between two fixes that move along a course.
struct CourseStep {
  double turn_rad_s = 0.0;
  double forward_m_s2 = 0.0, right_m_s2 = 0.0;  ///< change of speed; speed times turn
};

/// Nothing where one of the two is slower than `least_m_s` or has no course.
std::optional<CourseStep> course_step(const Fix& a, const Fix& b, double least_m_s) {
  const double step = b.time_s - a.time_s;
  if (!a.velocity_ned_m_s || !b.velocity_ned_m_s || step > 2.0 || !a.has_course || !b.has_course) {
    return std::nullopt;
  }
  const double before = a.velocity_ned_m_s->head<2>().norm();
  const double after = b.velocity_ned_m_s->head<2>().norm();
  if (std::min(before, after) <= least_m_s) {
    return std::nullopt;
  }
  CourseStep found;
  found.turn_rad_s = std::remainder(std::atan2(b.velocity_ned_m_s->y(), b.velocity_ned_m_s->x()) -
                                        std::atan2(a.velocity_ned_m_s->y(), a.velocity_ned_m_s->x()),
                                    2.0 * std::numbers::pi) /
                     step;
  found.forward_m_s2 = (after - before) / step;
  found.right_m_s2 = 0.5 * (before + after) * found.turn_rad_s;
  return found;
}

Status check_force(const Drive& drive) {
  Vector3 mean = Vector3::Zero();
  double magnitude = 0.0;
  double count = 0.0;
  for (const UniformRun& run : drive.runs) {
    for (const ImuSample& sample : run.readings) {
      const Vector3 force(sample[3], sample[4], sample[5]);
      mean += force;
      magnitude += force.norm();
      count += 1.0;
    }
  }
  mean /= count;
  magnitude /= count;
  if (magnitude < 5.0 || magnitude > 20.0) {
    const double g = magnitude / kStandardGravity;
    const bool plain_g = std::abs(magnitude - 1.0) < 0.3;
    const bool twice = std::abs(g - kStandardGravity) < 3.0;
    return implausible("imu.columns", "The specific force is " + std::to_string(magnitude) +
                                          " m/s^2 in the mean; at rest it is 9.8. " +
                                          (plain_g ? "Its unit is g."
                                           : twice ? "Its unit is m/s^2."
                                                   : "Is its unit right?"));
  }
  if (drive.document.vehicle != Vehicle::Foot && mean.z() > 0.5 * magnitude) {
    return implausible("imu.mounting_deg",
                       "The mean force points down: the body's z axis points up. Body axes are forward, right, down; "
                       "turn the unit by mounting_deg.");
  }
  return {};
}

Status check_path(const Drive& drive) {
  double by_velocity = 0.0;
  double by_position = 0.0;
  Product vertical;
  Product straight;  // displacement on velocity, north on north and east on east
  Product crossed;   // north on east and east on north
  Product turning;
  for (std::size_t i = 1; i < drive.fixes.size(); ++i) {
    const Fix& a = drive.fixes[i - 1];
    const Fix& b = drive.fixes[i];
    const double step = b.time_s - a.time_s;
    if (!a.velocity_ned_m_s || !b.velocity_ned_m_s || step > 2.0) {
      continue;
    }
    const Vector3 moved = ned_axes(a.position_ecef_m).transpose() * (b.position_ecef_m - a.position_ecef_m);
    const Vector3 expected = 0.5 * step * (*a.velocity_ned_m_s + *b.velocity_ned_m_s);
    if (expected.head<2>().norm() > 2.0 * step) {
      by_velocity += expected.head<2>().norm();
      by_position += moved.head<2>().norm();
      straight.add(moved.x(), expected.x());
      straight.add(moved.y(), expected.y());
      crossed.add(moved.x(), expected.y());
      crossed.add(moved.y(), expected.x());
    }
    if (b.velocity_sd_m_s.z() < 5.0) {
      vertical.add(moved.z() / step, expected.z() / step);
    }
    if (const auto course = course_step(a, b, 3.0); course && std::abs(course->turn_rad_s) > 5.0 * kDegree) {
      if (const auto read = mean_reading(drive.runs, a.time_s, b.time_s)) {
        turning.add(course->turn_rad_s, read->rate.z());
      }
    }
  }
  if (by_velocity > 200.0) {
    const double ratio = by_position / by_velocity;
    if (ratio > 30.0 || ratio < 1.0 / 30.0) {
      return implausible("gnss.columns", ratio > 30.0
                                             ? "The positions move " + std::to_string(ratio) +
                                                   " times as far as the velocities say: latitude and longitude are in "
                                                   "degrees, not radians, or the velocity is in km/s."
                                             : "The positions move " + std::to_string(ratio) +
                                                   " times as far as the velocities say: latitude and longitude are in "
                                                   "radians, not degrees.");
    }
    if (crossed.correlation() > kSwapped && straight.correlation() < kSwapped - 0.2) {
      return implausible("gnss.columns",
                         "The positions move north where the velocities say east, and east where they say north: "
                         "latitude and longitude are swapped, or the velocities north and east.");
    }
    if (ratio > 2.0 || ratio < 0.5) {
      return implausible("gnss.columns", "The positions move " + std::to_string(ratio) +
                                             " times as far as the velocities say; is the velocity's unit right (m/s, "
                                             "km/h, knots), and are latitude and longitude in their columns?");
    }
  }
  if (vertical.count > 100 && vertical.correlation() < -0.5) {
    return implausible("gnss.columns",
                       "The height falls where the velocity says that it rises: the vertical velocity is up where the "
                       "document says down, or the other way round.");
  }
  if (drive.document.vehicle != Vehicle::Foot && turning.count > 20 && turning.correlation() < -0.5) {
    return implausible("imu.columns",
                       "The gyroscope turns left where the course turns right: the unit's axes are left-handed or its "
                       "mounting_deg is wrong.");
  }
  return {};
}

/// The accelerometer's x and y against the changes of speed and the turns of a vehicle that moves along its nose. The
/// mean force is taken off: a unit that is tilted reads gravity.
Status check_horizontal_axes(const Drive& drive) {
  if (!moves_along_its_nose(drive.document.vehicle)) {
    return {};
  }
  std::vector<std::pair<CourseStep, Vector3>> steps;
  Vector3 mean = Vector3::Zero();
  std::size_t first = 0;
  for (std::size_t i = 1; i < drive.fixes.size(); ++i) {
    const Fix& from = drive.fixes[first];
    const Fix& to = drive.fixes[i];
    if (to.time_s - from.time_s < kWindow) {
      continue;
    }
    first = i;
    const auto course = course_step(from, to, 3.0);
    const auto read = course ? mean_reading(drive.runs, from.time_s, to.time_s) : std::nullopt;
    if (course && read) {
      steps.emplace_back(*course, read->force);
      mean += read->force;
    }
  }
  if (steps.size() < kEnoughIntervals) {
    return {};
  }
  mean /= static_cast<double>(steps.size());
  Product along;    // forward on x
  Product across;   // right on y
  Product crossed;  // forward on y
  Product other;    // right on x
  for (const auto& [course, force] : steps) {
    along.add(course.forward_m_s2, force.x() - mean.x());
    across.add(course.right_m_s2, force.y() - mean.y());
    crossed.add(course.forward_m_s2, force.y() - mean.y());
    other.add(course.right_m_s2, force.x() - mean.x());
  }
  const double many = static_cast<double>(steps.size());
  const bool speeds = std::sqrt(along.xx / many) > kEnoughForce;
  const bool turns = std::sqrt(across.xx / many) > kEnoughForce;
  if (speeds && turns && std::abs(crossed.correlation()) > kExchanged && std::abs(other.correlation()) > kExchanged) {
    return implausible("imu.columns",
                       "The accelerometer's y follows the changes of speed and its x the turns: x and y are exchanged "
                       "or mounting_deg is wrong. Body axes are forward, right, down.");
  }
  if (speeds && along.correlation() < kMirrored) {
    return implausible("imu.columns",
                       "The accelerometer's x points back where the speed rises: mounting_deg is wrong, or the axis is "
                       "mirrored, which \"axis\": \"-x\" says. Body axes are forward, right, down.");
  }
  if (turns && across.correlation() < kMirrored) {
    return implausible("imu.columns",
                       "The accelerometer's y points left where the course turns right: mounting_deg is wrong, or the "
                       "axis is mirrored, which \"axis\": \"-y\" says. Body axes are forward, right, down.");
  }
  return {};
}

}  // namespace

Status check_plausible(const Drive& drive) {
  if (auto status = check_force(drive); !status) {
    return status;
  }
  if (auto status = check_path(drive); !status) {
    return status;
  }
  return check_horizontal_axes(drive);
}

Result<Matrix3> found_mounting(const std::vector<UniformRun>& runs, const std::vector<Fix>& fixes) {
  // Down is where the force does not point, in the mean: changes of speed and turns average out over a drive.
  Vector3 mean = Vector3::Zero();
  for (const UniformRun& run : runs) {
    for (const ImuSample& sample : run.readings) {
      mean += Vector3(sample[3], sample[4], sample[5]);
    }
  }
  const Matrix3 level = Quaternion::FromTwoVectors(mean.normalized(), Vector3(0.0, 0.0, -1.0)).toRotationMatrix();
  // In level axes the force is e^{i yaw} (dv/dt, v w): least squares over the intervals between fixes.
  double real = 0.0;
  double imaginary = 0.0;
  double energy = 0.0;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    const Fix& a = fixes[i - 1];
    const Fix& b = fixes[i];
    const double step = b.time_s - a.time_s;
    if (!a.velocity_ned_m_s || !b.velocity_ned_m_s || step > 2.0) {
      continue;
    }
    const double speed_a = a.velocity_ned_m_s->head<2>().norm();
    const double speed_b = b.velocity_ned_m_s->head<2>().norm();
    if (std::min(speed_a, speed_b) < 2.0) {
      continue;
    }
    const auto read = mean_reading(runs, a.time_s, b.time_s);
    if (!read) {
      continue;
    }
    const Vector3 force = level * read->force;
    const double along = (speed_b - speed_a) / step;
    const double across = 0.5 * (speed_a + speed_b) * (level * read->rate).z();
    real += force.x() * along + force.y() * across;
    imaginary += force.y() * along - force.x() * across;
    energy += along * along + across * across;
  }
  if (energy < 10.0) {
    return fail(ErrorCode::InvalidArgument,
                "The drive changes its speed too little to find the unit's mounting from it; give mounting_deg.",
                {{"parameter", "imu.mounting_deg"}});
  }
  const double yaw = std::atan2(imaginary, real);  // from forward to the level x axis
  return Matrix3(Eigen::AngleAxisd(-yaw, Vector3::UnitZ()).toRotationMatrix() * level);
}

}  // namespace driftlab::drive
