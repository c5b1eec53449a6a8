#pragma once
/// What remains without a name, as profiles that are measured, judged on data that they were not fitted to, and carried
/// in the extended model.
///
/// Where checks still fail after every finding has been taken out, the model can be extended although no cause is
/// known. The checks of an automatic base are made on innovations that are whitened once more (fullrate/full_rate.hpp)
/// and cannot see a density that the model does not have: the spectrum is therefore tried where every check passes too.
///
/// Three kinds of profiles are tried (unnamed/unnamed_effect.hpp), each in all recordings together:
///   - the spectrum of the residuals over that of the model, in 14 bands of equal width in ln f, or in 42 if they
///     predict better;
///   - the mean square of the innovations against rate, angular acceleration, temperature and angle, in 12 bins with
///     equal numbers of samples, and against time in each single recording;
///   - the mean against the same, by generalised least squares on block means (slow/slow_fit.hpp).
/// With bins b, estimates r_b and their variances v_b, a profile of ratios is drawn towards 1 by
///   r^_b = 1 + w_b (r_b - 1),   w_b = t^2/(t^2 + v_b),   t^2 = max(0, mean of (r_b - 1)^2 - v_b)
/// (the prior variance t^2 by moments), so that where there is nothing, nothing is changed.
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
  double chi_square = 0.0;        ///< of ratios: the sum of their squared deviations from 1, each over its variance
  std::string sentence;           ///< for people: where it is and how large
  /// The slow part of an automatic base as it is beside a mean, which it had followed; nothing: as it was.
  std::optional<std::vector<SlowComponent>> noise;

  [[nodiscard]] double per_sample() const { return samples > 0.0 ? heldout_gain / samples : 0.0; }
};

/// Which profiles are tried: where no check fails, only what the checks cannot see.
enum class UnnamedScope { All, SpectrumAlone };

/// Profiles of what is left in a channel after its findings, in the order in which they are adopted; mostly none.
/// `data`: the channel under the extended model. Deterministic. O(samples log samples).
[[nodiscard]] std::vector<UnnamedFinding> find_unnamed(const ChannelGroup& group, const FullRate& data,
                                                       UnnamedScope scope);

}  // namespace driftlab::investigate
