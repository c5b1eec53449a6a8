#pragma once
/// Two kinds of frames: the likelihood that a share of them, which come in runs, has a ratio of powers from a louder
/// law than the others.
///
/// With x the mean of m unit exponentials over that of M others, x / s is F-distributed with 2 m and 2 M degrees of
/// freedom, s its scale; the density of x is, but for a constant, s^-m (1 + m x / (M s))^-(m + M). Of the loud kind the
/// scale is rho s. The kinds are a Markov chain: a run of loud frames lasts L on the average, a share p is loud. Scale,
/// rho and p maximise the likelihood by expectation and maximisation with the smoothed chances of each frame (Baum,
/// Petrie, Soules and Weiss 1970), for each of a few L.
#include <vector>

namespace driftlab::investigate {

/// The F law with its numbers of ordinates.
struct FrameLaw {
  double m = 1.0;
  double others = 1.0;  ///< M

  /// ln of the density of x, without the constant.
  [[nodiscard]] double log_density(double x, double scale) const;
};

struct TwoKinds {
  double scale = 1.0;     ///< s
  double ratio = 1.0;     ///< rho
  double fraction = 0.0;  ///< p; 0: there is one kind
  double length = 1.0;    ///< L [frames]
  double gain = 0.0;      ///< twice the log likelihood over one kind
};

/// The frames of each recording in their order.
using FrameRuns = std::vector<std::vector<double>>;

/// The scale of one kind, within a factor of 10 of 1.
[[nodiscard]] double best_scale(const FrameLaw& law, const FrameRuns& runs);

[[nodiscard]] double log_likelihood(const FrameLaw& law, const FrameRuns& runs, const TwoKinds& kinds);

/// Chance of each frame to be of the loud kind, all frames seen.
[[nodiscard]] FrameRuns loud_chances(const FrameLaw& law, const FrameRuns& runs, const TwoKinds& kinds);

/// Maximum of the likelihood over scale, ratio (1.2 to 1e5), fraction (at most one half) and the lengths tried.
/// O(frames).
[[nodiscard]] TwoKinds fit_two_kinds(const FrameLaw& law, const FrameRuns& runs);

}  // namespace driftlab::investigate
