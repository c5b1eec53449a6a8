#pragma once
/// The faults of recordings, found and repaired before any model is fitted.
///
/// Causes of the family RecordingFault are examined in the order of the registry, each on the study as repaired by
/// those before it. A recording whose gain on its own motion is odd, though neither sign, axis nor unit explains it, is
/// set aside: it is another motion than the one stated, or another sensor, and would be taken for a cause.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/consistency/recording_gains.hpp"

#include <deque>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace driftlab::investigate {

struct RecordingFinding {
  const Cause* cause = nullptr;
  FaultyRecordings fault;
};

/// A recording that is left out, and why.
struct SetAside {
  std::string recording;
  std::string channel;
  std::string sentence;
  double gain = 0.0;
  double deviation = 0.0;
};

struct RightedRecordings {
  std::optional<Study> study;  ///< put right; nothing where all recordings are as they should be
  std::deque<std::vector<double>> rows;
  std::vector<RecordingFinding> findings;
  std::vector<SetAside> aside;
};

/// The study is copied only if something is wrong with it. Once a stop is requested, the remaining causes are not
/// examined. O(samples log samples).
[[nodiscard]] RightedRecordings right_recordings(const Study& study, const std::stop_token& stop = {});

}  // namespace driftlab::investigate
