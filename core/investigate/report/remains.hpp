#pragma once
/// Departures from white noise that remain in the innovations after every finding has been taken out, with no cause
/// assumed.
///
/// Under a right model innovations are white and of unit variance, so that any sum over them has a known law. They are
/// first replaced by normal scores over all recordings of the channel, with uniform noise of one step added where the
/// file is on a lattice: heavy tails, gross values and equal values then do not disturb the tests. The tests are
///   - tiles: the mean power r of m ordinates in an interval of time and a band of frequency, against the rest of the
///     recording in that band, for dyadic intervals and bands; m (r - 1 - ln r) / (1 - share) has a unit exponential
///     tail, `share` the part of the recording in the interval;
///   - the mean over dyadic intervals of time, S^2/2 of unit variance;
///   - lines in the variance: the periodogram of the squared scores less one;
///   - skewness, of the innovations themselves, cut at six;
///   - between axes of a recording, |C|^2 of m ordinates in dyadic bands, m |C|^2.
/// A place is paid for by the number of places (Bonferroni); places overlap, so that the probabilities are too large
/// rather than too small. The smallest of a study is multiplied by the number of tests in it.
#include "core/investigate/report/report.hpp"
#include "core/investigate/search/group_search.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// Departures with a p_study below this level are reported.
inline constexpr double kShown = 0.003;

/// One departure.
struct Remainder {
  std::string id;  ///< of its check
  std::string recording;
  std::string channel;
  double observed = 0.0;  ///< the exponent: -ln of the chance at that place
  double places = 1.0;
  double p_study = 1.0;
  bool in_time_or_frequency = false;  ///< bursts, lines and changes: what a named cause should have taken away
  std::string sentence;               ///< where it is, in words
};

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

/// Adds a check and an entry of `unexplained` for each departure below kShown, at most three of a channel.
void report_remains(const std::vector<Remainder>& remains, Report& report);

}  // namespace driftlab::investigate
