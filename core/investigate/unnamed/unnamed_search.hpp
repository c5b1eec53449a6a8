#pragma once
/// What remains without a name, as profiles that are measured, judged on data that they were not fitted to, and carried
/// in the extended model.
///
/// Where something is left after every finding has been taken out, the model can be extended although no cause is
/// known. Profiles are tried where every check passes too: those of an automatic base are made on innovations that are
/// whitened once more (fullrate/full_rate.hpp), and slow noise may have followed a mean, so that they can see neither.
///
/// Three kinds of profiles are tried (unnamed/unnamed_effect.hpp), each in all recordings together:
///   - the spectrum of the residuals over that of the model, in 14 or 42 bands of equal width in ln f or in 40 of
///     equal width in f, whichever predict best;
///   - the mean square of the innovations against rate, angular acceleration, temperature, its rate of change and
///     angle, in 12 bins with equal numbers of samples, and against time and against the phase of a period in each
///     single recording;
///   - the mean against the same, by generalised least squares on block means (slow/slow_fit.hpp).
/// With bins b, estimates r_b and their variances v_b, a profile of ratios is drawn towards 1 by
///   r^_b = 1 + w_b (r_b - 1),   w_b = t^2/(t^2 + v_b),   t^2 = max(0, mean of (r_b - 1)^2 - v_b)
/// (the prior variance t^2 by moments), so that where there is nothing, nothing is changed.
///
/// The period of what comes again in a recording is found first (unnamed/period_search.hpp) and counts with all others
/// that were tried; every second period is held out.
///
/// Under an automatic base the mean ratio is a level that the base takes (search/joint_refit.hpp), and is divided out.
///
/// A profile is fitted to a part of the data and scored by its log likelihood on the rest, and the parts change roles:
/// the halves of each recording for spectra; other recordings for what goes with a quantity, or, in a single recording,
/// segments that take turns. It is adopted if it gains more than 6 + 2 ln(profiles tried) [nat], the largest first;
/// what it explains is taken out before the next is judged. The constants are those of spec/trust-notes.md, section 7.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/unnamed/unnamed_effect.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab::investigate {

struct UnnamedFinding {
  UnnamedEffect effect;
  std::vector<double> middle;     ///< of the bins; of frequencies the geometric one [SI]
  std::vector<double> low, high;  ///< the values with 1.96 of their standard errors, before they are drawn
  double heldout_gain = 0.0;      ///< log likelihood gained on data that it was not fitted to [nat]
  double samples = 0.0;           ///< of those data
  double tried = 1.0;             ///< profiles, of which this is the best

  /// Bound of the chance of such a gain in one of `channels` where the model is right. On data that it was not fitted
  /// to, the likelihood ratio of a profile has a mean of 1 under the model, so that its logarithm exceeds g with a
  /// chance of exp(-g) at most (Ville); here it is the sum over roles of the data that are not independent: exp(-g/2),
  /// times the profiles tried.
  [[nodiscard]] double chance(std::size_t channels) const;
  std::string sentence;  ///< for people: where it is and how large
  /// The slow part as it is beside a mean, which it had followed; nothing: as it was. A given base stays as it is.
  std::optional<std::vector<SlowComponent>> noise;

  [[nodiscard]] double per_sample() const { return samples > 0.0 ? heldout_gain / samples : 0.0; }
};

/// Profiles of what is left in a channel after its findings, in the order in which they are adopted; mostly none.
/// `data`: the channel under the extended model, of whose slow components the first `base` are the baseline's and the
/// others were found. Deterministic. O(samples log samples).
[[nodiscard]] std::vector<UnnamedFinding> find_unnamed(const ChannelGroup& group, const FullRate& data,
                                                       std::size_t base);

/// Profiles of the mean or of the noise's power against the quantities, that predict recordings as they are without the
/// findings, `data`: what may be there in place of a mean effect or of a level that was found. Those that would be
/// adopted.
[[nodiscard]] std::vector<UnnamedFinding> find_instead(const ChannelGroup& group, const FullRate& data,
                                                       UnnamedKind kind);

}  // namespace driftlab::investigate
