#include "core/navigate/drive/start.hpp"

#include "core/navigate/drive/drive_outage.hpp"
#include "core/navigate/earth.hpp"
#include "core/signal/angle.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

// spec/drives.md, section 3.
constexpr double kShortestRest = 2.0;        ///< [s]
constexpr double kHeadingSpeed = 3.0;        ///< [m/s]
constexpr double kMostTurn = 3.0 * kDegree;  ///< within a second

// Chosen, not measured.
constexpr double kBlock = 0.5;  ///< [s]
constexpr double kSteadyRate = 0.6 * kDegree;
constexpr double kSteadyForce = 0.2;  ///< [m/s^2]
constexpr double kOldestRest = 60.0;  ///< [s] before the start
constexpr double kBeginning = 5.0;    ///< [s] of a drive: fixes within it are where the document says that it begins
constexpr double kNeighbour = 1.5;    ///< [s]: fixes that tell the acceleration lie this near, and half as far at least

// Standard deviations at the start. Section 3 gives those of the tilt in motion (2 to 3 deg) and of the heading.
constexpr double kHeadingSd = 5.0 * kDegree;
constexpr double kHeadingSdOfDrifting = 30.0 * kDegree;  ///< of what does not move along its nose
constexpr double kTiltSdInMotion = 3.0 * kDegree;
constexpr double kDoubted = 0.5;  // share of an acceleration by velocities that are late and smoothed; chosen
constexpr double kTiltSdFromRest = 1.0 * kDegree;  // chosen, not measured, as are the next three
constexpr double kTiltSdStated = 2.0 * kDegree;    // the document has no place for its own
constexpr double kBesidePositionVariance = 1.0;    ///< [m^2], beside what the fix states
constexpr double kBesideVelocityVariance = 0.25;   ///< [m^2/s^2]

std::size_t reading_at(const UniformRun& run, double time_s) {
  const double at = std::ceil((time_s - run.start_s) / run.dt_s - 1e-9);
  return std::min(static_cast<std::size_t>(std::max(at, 0.0)), run.readings.size());
}

struct BlockMeans {
  double from_s = 0.0;
  Vector3 rate = Vector3::Zero(), force = Vector3::Zero();
};

BlockMeans mean_of(const UniformRun& run, std::size_t first, std::size_t last) {
  BlockMeans block{run.start_s + static_cast<double>(first) * run.dt_s, Vector3::Zero(), Vector3::Zero()};
  for (std::size_t i = first; i < last; ++i) {
    const ImuSample& sample = run.readings[i];
    block.rate += Vector3(sample[0], sample[1], sample[2]);
    block.force += Vector3(sample[3], sample[4], sample[5]);
  }
  block.rate /= static_cast<double>(last - first);
  block.force /= static_cast<double>(last - first);
  return block;
}

/// Attitude in level axes, heading 0 at the rest, carried from a rest to reading `to`.
Quaternion carried(const UniformRun& run, const Rest& rest, std::size_t to) {
  EulerAngles level;
  level.roll_rad = std::atan2(-rest.force.y(), -rest.force.z());
  level.pitch_rad = std::atan2(rest.force.x(), std::hypot(rest.force.y(), rest.force.z()));
  Quaternion attitude = from_euler(level);
  for (std::size_t i = reading_at(run, rest.to_s); i < to; ++i) {
    const ImuSample& sample = run.readings[i];
    attitude = attitude * rotation((Vector3(sample[0], sample[1], sample[2]) - rest.rate) * run.dt_s);
  }
  return attitude.normalized();
}

/// The acceleration of the vehicle around a fix, by the velocities of its neighbours, forward and to the right of a
/// heading; 0 where they have none within kNeighbour.
Vector3 acceleration_around(const Drive& drive, const Fix& fix, double heading_rad) {
  const Fix* before = nullptr;
  const Fix* after = nullptr;
  for (const Fix& other : drive.fixes) {
    const bool near = other.velocity_ned_m_s && std::abs(other.time_s - fix.time_s) < kNeighbour;
    before = near && other.time_s < fix.time_s - 0.5 * kNeighbour ? &other : before;
    after = near && other.time_s > fix.time_s + 0.5 * kNeighbour && after == nullptr ? &other : after;
  }
  before = before != nullptr ? before : &fix;
  after = after != nullptr ? after : &fix;
  if (!before->velocity_ned_m_s || !after->velocity_ned_m_s || !(after->time_s > before->time_s)) {
    return Vector3::Zero();
  }
  const Vector3 north_east_down =
      (*after->velocity_ned_m_s - *before->velocity_ned_m_s) / (after->time_s - before->time_s);
  return Eigen::AngleAxisd(-heading_rad, Vector3::UnitZ()) * north_east_down;
}

/// The gyroscope's turn about down within half a second on both sides.
double turn_around(const UniformRun& run, double time_s) {
  const std::size_t first = reading_at(run, time_s - 0.5);
  const std::size_t last = reading_at(run, time_s + 0.5);
  double turn = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    turn += run.readings[i][2] * run.dt_s;
  }
  return std::abs(turn);
}

/// The fix at which the filter begins.
const Fix* first_heading(const Drive& drive, const UniformRun& run, bool stated) {
  for (const Fix& fix : drive.fixes) {
    if (fix.time_s < run.start_s + 1.0 || fix.time_s > run.end_s() - 1.0) {
      continue;
    }
    const bool shows = fix.velocity_ned_m_s && fix.has_course &&
                       fix.velocity_ned_m_s->head<2>().norm() > kHeadingSpeed &&
                       turn_around(run, fix.time_s) < kMostTurn;
    if (stated || shows) {
      return &fix;
    }
  }
  return nullptr;
}

}  // namespace

EulerAngles Start::attitude() const {
  return to_euler(Quaternion(ned_axes(state.position_ecef_m)).conjugate() * state.attitude);
}

bool steady(const Vector3& rate_change, const Vector3& force_change) {
  return rate_change.norm() < kSteadyRate && force_change.norm() < kSteadyForce;
}

std::vector<Rest> rests_of(const Drive& drive, std::size_t run_index) {
  const UniformRun& run = drive.runs[run_index];
  const auto length = std::max<std::size_t>(1, static_cast<std::size_t>(kBlock / run.dt_s));
  std::vector<BlockMeans> blocks;
  for (std::size_t i = 0; i + length <= run.readings.size(); i += length) {
    blocks.push_back(mean_of(run, i, i + length));
  }
  std::vector<bool> moving(blocks.size(), false);
  for (const Fix& fix : drive.fixes) {
    const double at = (fix.time_s - run.start_s) / (static_cast<double>(length) * run.dt_s);
    if (at >= 0.0 && at < static_cast<double>(moving.size()) && fix.velocity_ned_m_s && fix.has_course &&
        fix.velocity_ned_m_s->head<2>().norm() >= kRestSpeed) {
      moving[static_cast<std::size_t>(at)] = true;
    }
  }
  std::vector<Rest> rests;
  const double block_s = static_cast<double>(length) * run.dt_s;
  const auto least = static_cast<std::size_t>(std::ceil(kShortestRest / block_s));
  for (std::size_t first = 0; first < blocks.size();) {
    std::size_t last = first;
    Rest rest;
    while (last < blocks.size() && !moving[last]) {
      const double many = static_cast<double>(last - first);
      if (last != first && !steady(blocks[last].rate - rest.rate / many, blocks[last].force - rest.force / many)) {
        break;
      }
      rest.rate += blocks[last].rate;
      rest.force += blocks[last].force;
      ++last;
    }
    if (last - first >= least) {
      rest.rate /= static_cast<double>(last - first);
      rest.force /= static_cast<double>(last - first);
      rest.from_s = blocks[first].from_s;
      rest.to_s = blocks[last - 1].from_s + block_s;
      rests.push_back(rest);
    }
    first = std::max(last, first + 1);
  }
  return rests;
}

Result<Start> find_start(const Drive& drive, std::size_t run_index) {
  const UniformRun& run = drive.runs[run_index];
  const StartState stated = run_index == 0 ? drive.document.start : StartState{};  // nothing behind a gap
  const Fix* const fix = first_heading(drive, run, stated.heading_rad.has_value());
  if (fix == nullptr && !drive.has_velocities()) {
    return fail(ErrorCode::InvalidArgument,
                "No fix has a velocity, so no course shows the heading; give start.heading_deg.",
                {{"parameter", "start.heading_deg"}});
  }
  if (fix == nullptr) {
    return fail(ErrorCode::InvalidArgument,
                "No fix moves faster than 3 m/s in a straight line, so the heading is not observable; give "
                "start.heading_deg.",
                {{"parameter", "start.heading_deg"}});
  }
  Start start;
  start.run = run_index;
  start.reading = reading_at(run, fix->time_s);
  start.time_s = run.start_s + static_cast<double>(start.reading) * run.dt_s;
  // What the document says is that of the beginning: by a later fix the vehicle is elsewhere.
  const bool at_beginning = fix->time_s < run.start_s + kBeginning;
  const Vector3 of_fix = fix->velocity_ned_m_s.value_or(Vector3::Zero());
  const Vector3 velocity = at_beginning ? stated.velocity_ned_m_s.value_or(of_fix) : of_fix;
  const bool straight = moves_along_its_nose(drive.document.vehicle);
  start.uncertainty.heading_sd_rad = straight || stated.heading_rad ? kHeadingSd : kHeadingSdOfDrifting;
  start.heading_from = stated.heading_rad ? HeadingFrom::Stated : HeadingFrom::Course;
  const double heading_rad = stated.heading_rad.value_or(std::atan2(velocity.y(), velocity.x()));
  EulerAngles angles;
  const Rest* rest = nullptr;
  const std::vector<Rest> rests = rests_of(drive, run_index);
  for (const Rest& one : rests) {
    if (one.to_s <= start.time_s && one.to_s > start.time_s - kOldestRest) {
      rest = &one;
    }
  }
  if (at_beginning && stated.roll_rad && stated.pitch_rad) {
    angles.roll_rad = *stated.roll_rad;
    angles.pitch_rad = *stated.pitch_rad;
    start.tilt_from = TiltFrom::Stated;
    start.uncertainty.tilt_sd_rad = kTiltSdStated;
  } else if (rest != nullptr) {
    angles = to_euler(carried(run, *rest, start.reading));
    start.tilt_from = TiltFrom::Rest;
    start.uncertainty.tilt_sd_rad = kTiltSdFromRest;
  } else {
    const BlockMeans around = mean_of(run, reading_at(run, start.time_s - 0.5), reading_at(run, start.time_s + 0.5));
    const Vector3 acceleration = acceleration_around(drive, *fix, heading_rad);
    const Vector3 force = around.force - acceleration;
    angles.roll_rad = std::atan2(-force.y(), -force.z());
    angles.pitch_rad = std::atan2(force.x(), std::hypot(force.y(), force.z()));
    start.uncertainty.tilt_sd_rad =
        std::hypot(kTiltSdInMotion, kDoubted * acceleration.head<2>().norm() / kStandardGravity);
  }
  angles.heading_rad = heading_rad;
  const Vector3 antenna = at_beginning && stated.position ? to_ecef(*stated.position) : fix->position_ecef_m;
  const Matrix3 axes = ned_axes(antenna);
  start.state.attitude = Quaternion(axes) * from_euler(angles);
  start.state.velocity_ecef_m_s = axes * velocity;
  start.state.position_ecef_m = antenna - start.state.attitude * drive.document.gnss.lever_arm_m +
                                (start.time_s - fix->time_s) * start.state.velocity_ecef_m_s;
  start.uncertainty.position_sd_m = (fix->position_sd_m.cwiseAbs2().array() + kBesidePositionVariance).sqrt();
  start.uncertainty.velocity_sd_m_s = (fix->velocity_sd_m_s.cwiseAbs2().array() + kBesideVelocityVariance).sqrt();
  return start;
}

}  // namespace driftlab::drive
