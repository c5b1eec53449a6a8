#pragma once
/// The grouping of recordings into sessions, each one power-up of the device.
///
/// The session is the replicate: the segments of one power-up are one session, in any number of files. Three segments
/// treated as three sessions fail an unchanged ADIS16405 in 6 of 30 comparisons (spec/regression.md, section 5). A
/// stated session holds; without one, recordings that begin within ten minutes of each other's end are one session;
/// without a time either, each file is taken for a session of its own, and the notes say so.
#include "core/campaign/regression/recordings.hpp"

#include <string>
#include <vector>

namespace driftlab::regression {

struct PowerUp {
  std::string name;                                  ///< the stated session, or that of its first recording
  std::vector<const ComparedRecording*> recordings;  ///< by id; at least one
};

struct PowerUps {
  std::vector<PowerUp> sessions;   ///< in an order that does not depend on that of the recordings
  std::vector<std::string> notes;  ///< sentences
};

/// The recordings must outlive the result.
[[nodiscard]] PowerUps group_sessions(const Recordings& arm);

}  // namespace driftlab::regression
