#pragma once
/// What is left in the innovations after every finding has been taken out: departures from white noise, sought without
/// an assumption about their cause.
///
/// Where the model is right, innovations are white and of unit variance, so that every sum over them has a known law.
/// The tests look at normal scores, not at the innovations as they are: each value is replaced by the normal quantile
/// of its rank among all recordings of the channel. Heavy tails and gross values then do not disturb them. Where the
/// file is on a lattice many values are equal; noise that is uniform over one step is added before they are ranked.
/// Each test gives an exponent x, and exp(-x) is the probability that noise alone would show as much at that place:
/// - Tiles. The recording is cut into dyadic intervals of time and dyadic bands of frequency. A tile has m ordinates,
///   and r is the mean of their powers, each divided by its mean over the recording. Then
///   x = m (r - 1 - ln r) / (1 - share), where `share` is the part of the recording that the interval takes: the tile
///   is in that mean itself.
/// - Mean over time. In dyadic intervals x = S^2/2, where S is the mean of the scores in units of its standard
///   deviation.
/// - Lines in the variance. x is the periodogram of the squared scores less their mean, over its expectation.
/// - Skewness. x = z^2/2 of the third moment of the innovations themselves, cut at six standard deviations.
/// - Codes that do not come alike: report/uneven_codes.hpp.
/// - Dependence, the distribution of means and loudness that axes share: report/dependence.hpp.
/// - Coherence. Between two axes of one recording x = m |C|^2 in dyadic bands of m ordinates, of innovations cut at
///   four standard deviations.
///
/// A test looks at many places and reports the one with the largest x, so the probability is multiplied by the number
/// of places (Bonferroni). Places overlap: the product is too large rather than too small. To say it of the whole study
/// it is multiplied once more, by the number of tests in the study.
#include "core/investigate/report/remainder.hpp"
#include "core/investigate/report/report.hpp"
#include "core/investigate/search/group_search.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// The strongest departure of each test within one channel that has been searched, `p_study` still to be told.
/// O(samples log samples). Deterministic.
[[nodiscard]] std::vector<Remainder> remains_of_channel(const ChannelGroup& group, const FullRate& data);

/// The departures of all channels and the strongest correlation between two channels, smallest probability first; those
/// with p_study below kShown are reported on their own. Only the innovations of usable outcomes are tested, and the
/// correlation of noise that was already found to be shared is not a departure. O(samples log samples) a pair.
/// Deterministic.
[[nodiscard]] std::vector<Remainder> what_remains(const std::vector<ChannelGroup>& groups,
                                                  const std::vector<GroupOutcome>& outcomes,
                                                  const std::vector<Evidence>& found,
                                                  std::vector<Remainder> of_channels);

/// Adds a check that fails before and after, and the sentence of what it shows. `check` has its observation and
/// chances.
void report_unexplained(Check check, const std::string& sentence, Report& report);

/// Adds a check and an entry of `unexplained` for each departure below kShown, at most three of a channel. What follows
/// from noise that changes in time is not told of a channel where such a change is.
void report_remains(const std::vector<Remainder>& remains, Report& report);

}  // namespace driftlab::investigate
