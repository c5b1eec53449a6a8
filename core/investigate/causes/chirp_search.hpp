#pragma once
/// The sinusoid of evenly running frequency that recordings hold most of.
///
/// It is sought in three stages, from many places looked at roughly to one looked at exactly:
///
/// 1. Maps. Each recording is cut into some thirty pieces. A chirp of slope c smears over c L^2 ordinates of a piece of
///    length L, so that pieces are taken against exp(i pi c t^2) first, for slopes c in steps of 4/L^2. Periodograms of
///    the pieces are added along every straight line through time and frequency.
/// 2. The lines that hold most are followed coherently over stretches of one piece, two, four and eight, on ever finer
///    grids of both ends.
/// 3. The best of them is followed over ever longer stretches, to the whole.
///
/// With r the mean of m unit exponentials along a line, m (r - 1 - ln r) has about a unit exponential tail. A chirp of
/// z in one recording of thirty-two pieces gives r = 1 + z^2/64: of z = 12 about 34 in stage 1, less what falls between
/// ordinates, where there are e^14 lines. Shared by five recordings it gives 13 there and 41 in stage 2, which is why
/// that stage begins with many lines. Of twenty chirps of z = 12 in white noise all are followed to both ends where one
/// recording or three hold it, eighteen where five do and twelve where seven do (chirp_search_test.cpp).
#include "core/investigate/causes/narrow_band.hpp"
#include "core/investigate/fullrate/full_rate.hpp"

#include <optional>
#include <vector>

namespace driftlab::investigate {

struct Followed {
  Sweep sweep;
  double x = 0.0;  ///< sum of X over the recordings (narrow_band.hpp)
};

/// Of each scope the chirp that fits best over the whole of its recordings, from one end of each to the other; nothing
/// where no line stands out of all that were looked along, or where recordings are shorter than a few pieces. Memory: 8
/// bytes a sample at most. O(n log n) for each slope, and n for each of at most 64 lines.
[[nodiscard]] std::vector<std::optional<Followed>> chirps_of(const FullRate& data,
                                                             const std::vector<std::vector<std::size_t>>& scopes);

/// The best sweep within `reach_hz` of one at either end.
[[nodiscard]] Followed follow_chirp(const FullRate& data, const std::vector<std::size_t>& scope, const Sweep& near,
                                    double reach_hz);

/// Of the longest recording of a scope [s].
[[nodiscard]] double longest_s(const FullRate& data, const std::vector<std::size_t>& scope);

}  // namespace driftlab::investigate
