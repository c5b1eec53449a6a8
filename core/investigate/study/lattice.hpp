#pragma once
/// The lattice of a file: the step of which all its values are multiples, and how coarse it is against the noise.
#include "core/investigate/study/study.hpp"

#include <span>

namespace driftlab::investigate {

struct Lattice {
  double step = 0.0;      ///< in the file's unit; 0: none seen
  double step_sd = 0.0;   ///< standard error of the step
  double decimals = 0.0;  ///< the finest decimal place the file writes, file unit
};

/// Values that are `step` times a whole number, within the decimals written. A step is only believed where it is at
/// least five times as coarse as the decimals, or the decimals themselves leave fewer than 200 distinct values.
/// O(n log n).
[[nodiscard]] Lattice find_lattice(std::span<const double> rows);

/// Standard deviation of the sample-to-sample noise of a channel [SI], from differences of its error, cut at five
/// robust deviations; 0 for a constant channel.
[[nodiscard]] double noise_of_differences(const StudyRecording& recording, const Channel& channel);

/// Modulus at which the output is clipped [file's unit]: at least eight values stand at the extreme while the reference
/// comes near it; 0 where nothing is clipped.
[[nodiscard]] double clipped_at(const Channel& channel);
[[nodiscard]] bool at_limit(double row, double limit);

}  // namespace driftlab::investigate
