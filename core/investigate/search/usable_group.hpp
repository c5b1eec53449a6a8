#pragma once
/// Whether a channel can be examined at all, before anything is sought in it.
#include "core/investigate/study/study.hpp"

#include <string>

namespace driftlab::investigate {

struct UsableGroup {
  std::string why_not;  ///< as the end of "It was not examined: ..."; empty where it can be
  std::string needs;    ///< what would make it usable
};

/// A group needs one sampling rate (to 1 %), values that change, 500 samples and a reference of the same motion
/// (core/investigate/study/reference_quality.hpp); the first that is lacking is told.
[[nodiscard]] UsableGroup usable_group(const ChannelGroup& group);

}  // namespace driftlab::investigate
