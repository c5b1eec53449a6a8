#pragma once
/// Whether a reference column is noisy or coarse at frequencies above those of the motion that it measures.
///
/// With a reading w + n and a reference w + u the error is n - u. Where the motion w has no power, reference and error
/// share u alone, with opposite sign: the regression of the error on the reference, S_ru/S_rr in a band of frequencies,
/// is -1 there, and -Re S_re is the density of u. Where the motion rules it is near 0, or the scale factor's error. The
/// spectra are those of second differences over Hann-tapered segments that overlap by half (Welch 1967), so that slow
/// motion does not leak into the bands above it.
#include "core/investigate/study/study.hpp"
#include "core/signal/estimate.hpp"

#include <cstddef>
#include <stop_token>
#include <vector>

namespace driftlab::investigate {

struct NoisyReference {
  std::size_t recording = 0;
  std::size_t axis = 0;
  std::size_t channel = 0;  ///< of the recording, that is compared with it
  Estimate density;         ///< N of u above `cut_hz` [SI/sqrt(Hz)]
  double step = 0.0;        ///< of the lattice of the reference [SI], where its values lie on a coarse one; else 0
  double cut_hz = 0.0;      ///< above it the reference tells no motion
  double share = 0.0;       ///< of the error's power above `cut_hz`
};

/// Every reference rate whose own noise is more than a fiftieth of the error's power above its motion. A reference
/// that shares no motion with its channel at any frequency is another matter, and left out. Nothing once `stop` is
/// asked. O(samples log samples).
[[nodiscard]] std::vector<NoisyReference> noisy_references(const Study& study, const std::stop_token& stop);

}  // namespace driftlab::investigate
