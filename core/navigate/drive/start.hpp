#pragma once
/// Where a filter begins on a recorded drive (spec/drives.md, section 3).
///
/// Tilt is the direction of the mean force over a rest, carried to the start by the gyroscope whose mean over that rest
/// is taken off; without a rest in the minute before, that of the force over one second of even motion. Heading is the
/// course of the first fix above 3 m/s whose second sees less than 3 deg of turn. A vehicle that does not move along
/// its nose has no such heading: it is taken from the document, else from the course with 30 deg.
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
