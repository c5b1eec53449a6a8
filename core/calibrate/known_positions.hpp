#pragma once
/// The positions of a calibration from recordings under known conditions (spec/study.md).
///
/// `six_position` along an axis, up or down: the accelerometers should read +g or -g there and 0 across.
/// `constant_rate` about an axis: the gyroscopes should read that rate there and 0 across; `static`: 0.
#include "core/calibrate/six_position.hpp"
#include "core/signal/recording_view.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// The channels of a sensor along x, y and z.
using Triad = std::array<const ChannelView*, 3>;

/// Nothing where one of the three is not there.
[[nodiscard]] std::optional<Triad> triad_of(const RecordingView& view, Quantity quantity);

struct KnownPositions {
  std::vector<KnownPosition> accelerometer;
  std::vector<KnownPosition> gyroscope;
  std::vector<std::string> notes;  ///< recordings that give no position, and why
};

/// Adds what one recording gives. The mean of each channel is taken over the rows that all three axes of the sensor
/// share. Errors: those of triad_mean; InvalidArgument (gravity not positive). A recording of another kind, or without
/// the three axes, gives a note.
[[nodiscard]] Status add_positions(const RecordingSpec& spec, const RecordingView& view, double gravity_m_s2,
                                   KnownPositions& positions);

}  // namespace driftlab
