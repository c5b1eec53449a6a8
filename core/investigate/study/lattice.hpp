#pragma once
/// The lattice of a file: the step of which all its values are multiples, and the size of that step relative to the
/// noise.
#include "core/investigate/study/study.hpp"

#include <span>
#include <stop_token>

namespace driftlab::investigate {

struct Lattice {
  double step = 0.0;      ///< in the file's unit; 0: none seen
  double step_sd = 0.0;   ///< standard error of the step
  double decimals = 0.0;  ///< the finest decimal place the file writes, file unit
};

/// Finds the step of which all values are whole multiples, within the decimals that the file writes. A step is accepted
/// only if it is at least five times the last decimal place, or if the decimals themselves leave fewer than 200
/// distinct values. O(n log m) in m distinct values, of which a lattice has few.
/// Once `stop` is asked it ends early, and what it gives counts for nothing.
[[nodiscard]] Lattice find_lattice(std::span<const double> rows, const std::stop_token& stop = {});

/// Standard deviation of the sample-to-sample noise of a channel [SI], from differences of its error, cut at five
/// robust deviations; 0 for a constant channel.
[[nodiscard]] double noise_of_differences(const StudyRecording& recording, const Channel& channel);

/// Standard deviation of the noise behind a lattice of step `step` [same unit] where that of the rounded differences is
/// `seen`: Sheppard's step^2/12 taken off. Where the noise is small against the step the rounded values hardly tell it.
[[nodiscard]] double noise_behind_lattice(double seen, double step);

/// The magnitude at which the output is clipped [file's unit]: at least eight values are at the extreme while the
/// reference comes near it. On a lattice of more than kCoarse of the noise many values are at an extreme without being
/// clipped; there the reference must go beyond it by a step and a half and three deviations of the noise, as the
/// channel reads it where it is slower. 0 if nothing is clipped.
[[nodiscard]] double clipped_at(const Channel& channel);
[[nodiscard]] bool at_limit(double row, double limit);

}  // namespace driftlab::investigate
