#pragma once
/// What is done to the candidate of a simulated regression run.
#include "tests/accuracy/regression_rig.hpp"

#include <cmath>

namespace driftlab::accuracy {

inline double unchanged(const regression::Row& /*row*/) { return 0.0; }
inline double at_margins(const regression::Row& row) { return row.margin; }
/// One scale of one axis exactly at its margin, all others 30 % better.
inline double at_margin_once(const regression::Row& row) {
  return row.unit == 2 && row.octave == 4 ? row.margin : std::log(0.7);
}

/// White noise of gyro y with its deviation larger by `share`.
inline Rig::Change white_noise(const Rig& rig, double share) {
  return [&rig, share](const regression::Row& row) {
    const double m = std::exp2(row.octave);
    const double more = (1.0 + share) * (1.0 + share) - 1.0;
    return row.unit == 1 ? 0.5 * std::log(1.0 + more * rig.white(m) / rig.variance(m)) : 0.0;
  };
}

/// A process that was not there, of such a level that the deviation of gyro z grows by `share` at `octave`.
inline Rig::Change new_process(const Rig& rig, Process process, int octave, double share) {
  process.parameters[0] = 1.0;
  const double at = std::exp2(octave);
  const double level = ((1.0 + share) * (1.0 + share) - 1.0) * rig.variance(at) / process.haar_variance(at, Rig::kDt);
  return [&rig, process, level](const regression::Row& row) {
    const double m = std::exp2(row.octave);
    return row.unit == 2 ? 0.5 * std::log(1.0 + level * process.haar_variance(m, Rig::kDt) / rig.variance(m)) : 0.0;
  };
}

/// A Gauss-Markov process of 0.32 s, which peaks at 0.64 s, and a random walk as it shows at 10 s.
inline Rig::Change new_markov(const Rig& rig, double share) {
  return new_process(rig, *make_process("gauss_markov", {1.0, 1.0 / 0.32}), 6, share);
}
inline Rig::Change new_walk(const Rig& rig, double share) {
  return new_process(rig, *make_process("random_walk", {1.0}), 10, share);
}

}  // namespace driftlab::accuracy
