#pragma once
/// Whether the evidence suffices to name a cause for a finding.
///
/// The best of the registered causes need not be right: an effect that no registered cause describes is still described
/// best by one of them. A finding is therefore marked ambiguous, with the reason in Evidence::doubt, if
///   - a parameter is at the bound of its search, or a time constant longer than twenty recordings;
///   - a bias that differs from recording to recording differs in one alone, of four or more: more than 95 % of the sum
///     of squares about the median is one recording's;
///   - a line comes a whole number of times a turn, up to twelve, in each of its recordings, which turn;
///   - a level of noise is that of the recordings that turn one way, though others turn the other way;
///   - slow noise, or a level, is that of recordings whose rate changes and of no other, though there are others;
///   - the correlation of one-second means still fails (p < 0.001) in a recording of a mean effect or of slow noise;
///   - a finding of the same thing (the mean, or the level of the noise) that gains three times as much is doubted;
///   - a level of noise predicts the recordings worse than a profile of the noise's power against a quantity does that
///     was measured without it;
///   - a mean effect, and all others of its channel together, predict the recordings worse than a profile of the mean
///     against one quantity does;
///   - a clock that is off all the time is found where one that breaks is not ruled out (`kClockMayBreak`);
///   - at least three checks fail with the extended model, and at least half as many as failed with the baseline;
///   - noise still changes in time or frequency, on the finding's channel, with p < 0.001 over the study (remains.hpp);
///     a mean effect is doubted by a change that a mean can make, and by none that shows less than a third of its gain;
///     gross values by none that gains less than they do;
///   - of tails: errors to one side are larger than to the other, with the same p, by a third of the finding's gain;
///   - a profile without a name (unnamed/unnamed_search.hpp) of what the finding is of (the mean, the level or the
///     spectrum of the noise) shows itself and predicts at least a third as much as the finding does; of tails, a
///     profile of the mean too, for what a mean displaces lies in the tails; of gross values none of the power, where
///     they stand out of its loudest bin by four deviations.
/// What all recordings of a channel show is no doubt of a difference between them (shared_misfit.hpp). Facts of a file
/// and faults of a recording are never doubted.
#include "core/investigate/report/remains.hpp"
#include "core/investigate/report/report.hpp"

#include <vector>

namespace driftlab::investigate {

/// Mean residual of each recording of a channel under the base model alone [SI].
[[nodiscard]] std::vector<double> means_of(const FullRate& before);

/// Recordings whose clock may break, where something was found that a break declares a rival.
[[nodiscard]] std::vector<const StudyRecording*> suspects_of(const Study& study, const std::vector<Evidence>& found);

/// What may be there instead of what was found.
struct Instead {
  std::vector<UnnamedFinding> beside;                ///< profiles beside the findings (find_unnamed)
  std::vector<UnnamedFinding> instead;               ///< in place of levels of noise and mean effects (find_instead)
  std::vector<const StudyRecording*> suspects = {};  ///< suspects_of
};

/// Whether profiles of that kind are asked whether they predict more than the finding does.
[[nodiscard]] bool may_be_a_profile(const Evidence& evidence, UnnamedKind kind);

/// Sets `doubt` and `ambiguous` of what was found. `means`: of every group (`means_of`). `report` holds the counts of
/// failed checks.
void doubt_what_is_not_earned(const std::vector<ChannelGroup>& groups, const std::vector<std::vector<double>>& means,
                              const std::vector<Remainder>& remains, const Instead& instead, const Report& report,
                              std::vector<Evidence>& found);

/// Whether a profile without a name shows something where every check passes: its chance over all `channels` is below
/// kShown, and a density or a power differs by 10 % somewhere; a mean always does.
[[nodiscard]] bool shows_itself(const UnnamedFinding& found, std::size_t channels);

}  // namespace driftlab::investigate
