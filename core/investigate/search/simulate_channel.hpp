#pragma once
/// One channel simulated from a model: its processes, its deterministic part and its effects (spec/causes.md).
///
/// reading = reference + white + slow + mean, then the steps of the output stage (clipping, rounding, stuck runs), then
/// samples that are absent and stamps that are wrong. An effect that cannot act (it needs a temperature that is not
/// stated, or belongs to other recordings) is listed as left out. Same seed, same bits.
#include "core/investigate/study/study.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace driftlab::investigate {

struct SimulatedChannel {
  std::vector<double> reading;         ///< [SI], over the file
  std::vector<unsigned char> present;  ///< 0: the sample is absent; empty: all are there
  std::vector<double> stamp_error_s;   ///< empty: exact stamps
  std::vector<std::string> left_out;   ///< causes that were not simulated, each with the reason
};

/// `recording` says how the channel `column` of `role` moves and how long (make_study_recording over blank columns).
/// O(samples (processes + effects)).
[[nodiscard]] SimulatedChannel simulate_channel(const Baseline& model, StudyRecording recording,
                                                const std::string& column, const ColumnRole& role, std::uint64_t seed);

}  // namespace driftlab::investigate
