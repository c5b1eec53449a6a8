#pragma once
/// The state in which a filter begins on a recorded drive (spec/drives.md, section 3). What the document of the drive
/// states is taken from there, for the beginning of the drive: behind a gap of the readings, and position and velocity
/// at a later start, they are found as all else is.
///
/// Tilt. The vehicle's last rest, if it ended within the minute before the start, shows the tilt by the direction of
/// the mean force. The gyroscope carries it from there to the start, less its own mean over the rest. Without such a
/// rest, the tilt is that of the mean force over one second around the start, less the acceleration that the velocities
/// of the fixes show there: 2 m/s^2 would be taken for 12 deg. Velocities of a receiver are late and smoothed, so that
/// half of what is taken off is in the tilt's standard deviation.
///
/// Heading. It is the course of the first fix that is faster than 3 m/s and around which the vehicle turns by less than
/// 3 deg in a second. The filter begins at that fix, or, where the heading is stated, at the first of all. An aircraft
/// or a boat need not point where it moves: its heading should be stated, and where it is not, the course is taken with
/// a standard deviation of 30 deg.
#include "core/navigate/attitude.hpp"
#include "core/navigate/drive/drive.hpp"

namespace driftlab::drive {

enum class TiltFrom { Stated, Rest, Motion };
enum class HeadingFrom { Stated, Course };

struct Start {
  std::size_t run = 0;      ///< of the drive
  std::size_t reading = 0;  ///< the first that the filter takes
  double time_s = 0.0;
  NavigationState state;
  InitialUncertainty uncertainty;
  TiltFrom tilt_from = TiltFrom::Motion;
  HeadingFrom heading_from = HeadingFrom::Course;

  [[nodiscard]] EulerAngles attitude() const;  ///< roll, pitch and heading of the body in the local level frame
};

/// A stretch in which the unit does not move.
struct Rest {
  double from_s = 0.0, to_s = 0.0;
  Vector3 rate = Vector3::Zero();   ///< mean of the gyroscope
  Vector3 force = Vector3::Zero();  ///< mean of the accelerometer
};

/// Whether a unit rests whose means of rate and force over half a second differ by these: by less than 0.6 deg/s and
/// 0.2 m/s^2. Means, because an engine shakes a unit at rest by many times its noise.
[[nodiscard]] bool steady(const Vector3& rate_change, const Vector3& force_change);

/// Stretches of two seconds and more in which the means of every half second are steady() about their common mean and
/// no fix moves at kRestSpeed (drive_outage.hpp) or more.
[[nodiscard]] std::vector<Rest> rests_of(const Drive& drive, std::size_t run);

/// Error: InvalidArgument where no fix shows a heading and the document gives none.
[[nodiscard]] Result<Start> find_start(const Drive& drive, std::size_t run);

}  // namespace driftlab::drive
