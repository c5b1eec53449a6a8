#pragma once
/// What a profile goes with, over the samples of each recording: a quantity, the time, or the phase of a period.
#include "core/investigate/study/study.hpp"
#include "core/investigate/unnamed/period_search.hpp"

#include <cstddef>
#include <vector>

namespace driftlab::investigate {

/// Samples that a profile is made of at least.
inline constexpr std::size_t kFewestOfProfile = 2'000;
/// Blocks of a recording whose means are looked at, at most.
inline constexpr std::size_t kMostBlocks = 20'000;

struct Courses {
  Against against = Against::Time;
  std::vector<std::size_t> members;  ///< that have it
  std::vector<Series> of;            ///< one per member of the group, over its analysed part; empty: not known there
  std::vector<double> edge;          ///< of the bins; empty: there is no profile along it
  double period_s = 0.0;             ///< of a phase, as the next two
  double periods = 0.0;              ///< in the recording
  double tried = 1.0;                ///< periods

  /// Whether they are of one recording and say nothing of another.
  [[nodiscard]] bool single() const { return against == Against::Time || against == Against::Phase; }
  /// Which of two parts of a single recording sample i of `count` belongs to: segments, or periods, take turns.
  [[nodiscard]] std::size_t part_of(std::size_t i, std::size_t count) const;
};

/// A quantity in all members that know it, in bins with equal numbers of samples (profile_bins.hpp).
[[nodiscard]] Courses courses_of(const ChannelGroup& group, Against against);
/// The time of member r, in 32 bins.
[[nodiscard]] Courses time_of(const ChannelGroup& group, std::size_t r);
/// The phase of a period of member r, in bins of its finest tooth's half wave and at most 128, none finer than a block.
[[nodiscard]] Courses phases_of(const ChannelGroup& group, std::size_t r, const FoundPeriod& found);

}  // namespace driftlab::investigate
