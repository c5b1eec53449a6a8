#pragma once
/// Gaps of a recording, filled so that its spectrum can be taken: a transform needs every sample.
///
/// Few missing samples stand on a straight line between their neighbours. A line lacks the noise of what it replaces,
/// and joins what was never joined; it adds to the deep parts of a spectrum about its share of the power. Where more is
/// missing, a gap takes the fluctuations of a whole piece of the same recording, drawn at random, about the mean of the
/// samples to its left and right: white noise keeps its level, and coloured noise its colour but for the two places
/// where a piece begins and ends. That mean stands in place of several samples that had none in common, so power is too
/// high at frequencies below about one over the time over which it is taken.
#include "core/investigate/study/series.hpp"

#include <vector>

namespace driftlab::investigate {

struct FilledGaps {
  Series values;        ///< no sample missing
  double broken = 0.0;  ///< share of the samples that do not follow their neighbours as the noise does
};

/// `used[i]`: sample i is there; `beside`: samples, at least one, to each side of a gap that tell the level there.
/// Deterministic. O(n); 20 bytes a sample while it runs, where more than 0.5 % are missing.
[[nodiscard]] FilledGaps fill_gaps(const Series& values, const std::vector<unsigned char>& used, std::size_t beside);

}  // namespace driftlab::investigate
