#pragma once
/// A part of the use case "read a stored result": what a simulation model implies beside a channel that was measured.
///
/// A model is made to be simulated, and not all that it holds has a curve. The curves are those of its processes on the
/// channel, with its drift [SI/s] as `linear_drift` and with the effects that are processes themselves wherever they
/// act: slow noise is added, a stated white level takes the place of the processes' own, differenced noise is added as
/// `quantization_noise` (as a given model is taken by an investigation, core/investigate/search/given_model.hpp). A
/// constant bias moves neither curve. Every other effect is left out, and said so.
#include "core/analysis/stored_channel.hpp"
#include "core/investigate/study/study.hpp"

#include <string>
#include <vector>

namespace driftlab {

struct ImpliedModel {
  Model processes;                    ///< of which the curves are [SI]
  ImpliedBeside beside;               ///< in the channel's own unit
  std::vector<std::string> left_out;  ///< causes of effects on the channel without a curve, each once; `unnamed`
};

/// Errors: NotFound (the model says nothing of the channel, or the result holds no Allan deviation of it).
/// O(times x processes).
[[nodiscard]] Result<ImpliedModel> implied_by(const investigate::Baseline& model, const StoredChannel& channel);

}  // namespace driftlab
