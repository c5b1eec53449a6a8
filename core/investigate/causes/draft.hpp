#pragma once
/// A simulated recording under construction, into which causes put their effects. The hidden tests and the simulator
/// use it.
///
/// It describes one channel. The white part, the slow part and the mean are kept apart until finish(), because effects
/// act on one of them: a level of white noise, or its tails, stand in the place of the white part, so that every noise
/// of another colour, differenced or resonant, is in the slow one. A cause with a template or a slow process needs no
/// code of its own here; the others have `Cause::inject`.
#include "core/investigate/causes/cause.hpp"
#include "core/process/random.hpp"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace driftlab::investigate {

struct Draft {
  StudyRecording* recording = nullptr;    ///< rates, forces, temperature set; channels come with finish()
  const ChannelGroup* group = nullptr;    ///< role of the channel; its members may be empty
  std::size_t number = 0;                 ///< of the recording in its study
  std::vector<double> white, slow, mean;  ///< over the file [SI]
  std::vector<double> shared;             ///< unit white noise that all axes of the recording share
  std::vector<std::function<void(std::vector<double>&)>> output;  ///< steps of the output stage, in order
  std::vector<unsigned char> present;                             ///< 0: the sample is absent; empty: all are there
  std::vector<double> reference;      ///< added to the column that tells the motion [SI]; empty: it is exact
  std::vector<double> stamp_error_s;  ///< empty: exact stamps
};

/// Puts `cause` with parameters `values` (SI, in declared order) into the draft. With fewer values than the cause has
/// parameters the draft stays as it is.
void inject(const Cause& cause, Draft& draft, std::span<const double> values, Random& random);

}  // namespace driftlab::investigate
