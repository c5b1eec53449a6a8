#pragma once
/// Reference columns put where the sensor was: the delay between a table's own clock and the recording is estimated and
/// taken out before the reference is subtracted.
///
/// A reference that is late by d leaves d times its slope in the error: 10 ms on a table that swings at 1 Hz by
/// 100 deg/s leave 6 deg/s. Only a reference that moves tells the delay: where the channel does not follow it (a
/// correlation below 0.5), or the 95 % interval is wider than one sample interval on either side or holds 0, the
/// reference stays where it is. The interval of the delay is reported;
/// what it leaves uncertain of the error series is not in the intervals of the variances.
#include "core/calibrate/time_alignment.hpp"
#include "core/signal/recording_view.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

struct ReferenceAlignment {
  std::string channel;
  std::string reference;                  ///< the column
  std::optional<TimeAlignment> estimate;  ///< nothing where it cannot be estimated
  std::string reason;                     ///< why not
  bool applied = false;
};

/// Estimates the delay of every channel with a reference column from its longest run without a gap (of more than
/// 100,000 samples the 100,000 in which the reference moves most), and shifts the reference where the delay is known.
/// The samples at the ends of each run whose reference would lie outside it are left out. Delays up to
/// AlignmentOptions::max_shift_s, less where the run is short. O(rows + 100,000 x delays in samples).
[[nodiscard]] std::vector<ReferenceAlignment> align_references(RecordingView& view,
                                                               const AlignmentOptions& options = {});

}  // namespace driftlab
