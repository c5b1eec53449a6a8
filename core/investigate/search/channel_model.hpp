#pragma once
/// The noise model of a channel after the search, without the effects that were found.
#include "core/investigate/slow/slow_model.hpp"
#include "core/investigate/study/study.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// The noise model of one channel, and what it cannot hold.
struct ChannelModel {
  std::string channel;
  Unit unit;
  Quantity quantity = Quantity::AngularRate;
  SlowModel base;      ///< N^2 and the slow processes without the effects
  double drift = 0.0;  ///< [SI/s], of an automatic baseline
  double bias = 0.0;   ///< [SI]
  bool given = false;
  Model given_processes;  ///< of a given baseline, as they came
};

}  // namespace driftlab::investigate
