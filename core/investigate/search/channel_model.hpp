#pragma once
/// The noise model of a channel after the search: with the effects that were found, and as if there were none.
#include "core/investigate/slow/slow_model.hpp"
#include "core/investigate/study/study.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// What a channel shows besides effects.
struct ChannelBase {
  SlowModel noise;            ///< N^2 and the slow processes
  double quantization = 0.0;  ///< Q^2 of differenced noise [SI^2 s^2], of an automatic baseline
  double drift = 0.0;         ///< [SI/s], of an automatic baseline
  double bias = 0.0;          ///< [SI]
};

/// The noise model of one channel, and what it cannot hold. An automatic baseline has two noise models: `alone` is
/// fitted to the recordings as if there were no effect, `beside` is fitted together with the effects found. A gain is
/// the difference in log likelihood between the two.
struct ChannelModel {
  std::string channel;
  Unit unit;
  Quantity quantity = Quantity::AngularRate;
  ChannelBase alone;   ///< no effect is known
  ChannelBase beside;  ///< beside the effects found
  bool given = false;
  Model given_processes;  ///< of a given baseline, as they came
};

}  // namespace driftlab::investigate
