#pragma once
/// A characterisation for the terminal, above and below its parameter tables.
#include "core/analysis/told_characterisation.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// The sentence of each channel with its mark: a line each, which names the recording where there are several.
[[nodiscard]] std::string verdicts_to_text(const std::vector<ToldRecording>& recordings);

/// The curves asked for with --taus, --total, --theo1 and --psd: one line per tau, density or spectral line; a dash
/// where there is no figure.
[[nodiscard]] std::string further_to_text(const std::vector<ToldRecording>& recordings);

}  // namespace driftlab
