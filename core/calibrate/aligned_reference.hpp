#pragma once
/// Estimation and removal of the delay between the clock of a reference (for instance a rate table) and the recording,
/// before the reference is subtracted.
///
/// A reference that is late by d leaves an error of d times its slope: 10 ms on a table that swings at 1 Hz with 100
/// deg/s leave 6 deg/s. Only a moving reference determines the delay. The reference is left unchanged if the channel
/// does not follow it (correlation below 0.5), or if the 95 % interval of the delay reaches further than one sample
/// interval to either side or contains 0. The interval of the delay is reported; the uncertainty that it leaves in the
/// error series is not included in the intervals of the variances.
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

/// Estimates the delay of every channel with a reference column, from its longest run without a gap; of a run of more
/// than 100,000 samples the 100,000 in which the reference moves most are used. Shifts the reference if the delay is
/// determined. Samples at the ends of each run whose reference would lie outside the run are left out. Delays are
/// sought up to AlignmentOptions::max_shift_s, or less if the run is short. O(rows + 100,000 x delays in samples).
[[nodiscard]] std::vector<ReferenceAlignment> align_references(RecordingView& view,
                                                               const AlignmentOptions& options = {});

}  // namespace driftlab
