#pragma once
/// The motion of a road vehicle from segments: horizontal, with the heading along the velocity and continuous rates.
///
/// Every manoeuvre is a pulse of heading rate or of acceleration. The pulse rises over `ramp_s` as a cubic smoothstep,
/// holds its value and falls again, so that rate and acceleration have continuous derivatives. Its integral is exactly
/// value times duration: a turn of 9 deg/s for 10 s turns by 90 deg and ends 10 s + ramp after its start. Pulses add,
/// so turns may overlap. Changes of speed have targets and may not overlap.
#include "core/navigate/motion.hpp"
#include "core/signal/result.hpp"

#include <memory>
#include <string_view>
#include <vector>

namespace driftlab {

enum class SegmentKind {
  Straight,    ///< nothing changes; a label for readers
  Turn,        ///< `rate_rad_s` for `duration_s`; positive to the right
  Accelerate,  ///< `acceleration_m_s2` until `until_speed_m_s`
  SCurve,      ///< `rate_rad_s` for `duration_s`, then the opposite for as long
  Stop,        ///< braking at `acceleration_m_s2` (its magnitude) to rest
};

[[nodiscard]] std::string_view name_of(SegmentKind kind);
/// By the name used in scenario documents: straight, turn, accelerate, s_curve, stop. Error: InvalidArgument.
[[nodiscard]] Result<SegmentKind> parse_segment_kind(std::string_view name);

struct Segment {
  SegmentKind kind = SegmentKind::Straight;
  double start_s = 0.0;
  double duration_s = 0.0;         ///< turn, each half of an S-curve
  double rate_rad_s = 0.0;         ///< turn, S-curve
  double acceleration_m_s2 = 0.0;  ///< accelerate (its sign follows from the target), stop
  double until_speed_m_s = 0.0;    ///< accelerate
};

struct SegmentPlan {
  Geodetic start;
  double speed_m_s = 0.0;
  double heading_rad = 0.0;
  double duration_s = 0.0;
  double ramp_s = 0.5;
  std::vector<Segment> segments;  ///< by start time
};

/// Errors: InvalidArgument naming the segment: starts not in order or outside the plan, a duration, ramp or
/// acceleration that is not positive, a speed below 0, a change of speed before the one before it has ended.
[[nodiscard]] Result<std::unique_ptr<Motion>> make_segment_motion(const SegmentPlan& plan);

}  // namespace driftlab
