#pragma once
/// A given model as the search uses it: it is taken as true and never refitted.
///
/// Its processes become the noise model, by the laws that their kinds declare. Drifts and mean effects with fixed shape
/// are subtracted from the error before anything is examined. Slow effects become processes. An effect that states the
/// density of the white noise takes the place of the processes' white level, and one that is differenced noise is added
/// to theirs; which effects these are, their causes declare (NoiseLevel and DifferencedNoise in causes/family.hpp).
/// Effects that cannot be subtracted from a recording (sinusoids, tails, band limits, facts of the file) stay in it; if
/// one is found again with parameters that agree with the model, this is a confirmation and not a finding. The constant
/// bias stays free: it is one number per channel and never a finding (spec/causes.md).
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/search/channel_model.hpp"
#include "core/investigate/slow/slow_model.hpp"
#include "core/investigate/study/study.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// Errors: InvalidArgument where a process of the baseline has no law by which it could be taken out of a recording
/// (core/process/process.hpp), and no cause is that process, so that it cannot be found again either.
[[nodiscard]] Status check_processes(const Baseline& baseline);

/// True where the baseline is given and speaks of this group.
[[nodiscard]] bool applies(const Baseline& baseline, const ChannelGroup& group);

/// The processes of the group's column: its own where it has some, else those of the whole model.
[[nodiscard]] const Model& processes_of(const Baseline& baseline, const ChannelGroup& group);

/// The effects that act on the group's column.
[[nodiscard]] std::vector<const GivenEffect*> effects_on(const Baseline& baseline, const ChannelGroup& group);

/// White level and slow processes, those of the effects included.
[[nodiscard]] SlowModel given_model(const Baseline& baseline, const ChannelGroup& group);

/// Q^2 of the differenced uniform noise [SI^2 s^2]; 0: none.
[[nodiscard]] double given_quantization(const Baseline& baseline, const ChannelGroup& group);

/// Takes drifts and mean effects off `error[r]`, over the grid of member r.
void take_given_means(const Baseline& baseline, const ChannelGroup& group, std::vector<Series>& error);

/// True if the baseline already contains the finding: an effect of the same cause in a recording of the finding, or a
/// process that no law takes out (a sinusoid) and that the cause adds, with every value within its interval.
[[nodiscard]] bool confirmed(const Baseline& baseline, const ChannelGroup& group, const Evidence& evidence);

/// The processes of a channel's noise: as they were given, or as they were fitted in `base`, one of the model's own.
/// Constant offsets are left out.
[[nodiscard]] Model noise_processes(const ChannelModel& model, const ChannelBase& base);

}  // namespace driftlab::investigate
