#pragma once
/// What the files of a channel show by themselves: facts, the samples that they spoil, and the step of the values.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/study/study.hpp"

#include <stop_token>
#include <vector>

namespace driftlab::investigate {

struct FileFacts {
  std::vector<Evidence> found;                   ///< each held out on what it does not spoil
  std::vector<std::vector<unsigned char>> mask;  ///< by member, over the grid: not 0 where a fact spoils the sample
  double lattice_step = 0.0;                     ///< [SI]: a fact's, else that of the values or of their last digit
};

/// Every cause of the registry that is a fact of the file is looked for, in its order; none that comes after `stop` is
/// asked.
[[nodiscard]] FileFacts look_at_files(const ChannelGroup& group, const std::stop_token& stop);

}  // namespace driftlab::investigate
