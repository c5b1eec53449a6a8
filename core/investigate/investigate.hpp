#pragma once
/// What a simulation gets wrong, and why: the investigation of a study (spec/causes.md).
///
/// First, among all recordings together: what is wrong with a recording (search/right_recordings.hpp) is named and put
/// right, or the recording is set aside. Then, per channel group (one sensor axis through all recordings):
///
/// 1. Facts of the file (missing, jittering, clipped, stuck samples, a coarse lattice) come first; the samples that
/// they spoil take no part in the later steps.
///
/// 2. Mean effects, slow noise and lines are searched together. The strongest is added to the model, and the search is
/// repeated with that model as the null hypothesis (forward selection).
///
/// 3. The residuals at full rate are searched for a band limit, for the level and modulation of the noise, for its
/// distribution and for its correlation between axes.
///
/// 4. Backward check: a finding that no longer earns its penalty beside all the others is removed.
///
/// The thresholds at which a cause is reported and called identified are in search/thresholds.hpp.
///
/// The folders, each of which builds on those before it: `study` (recordings on a grid, their references and how good
/// these are), `slow` (processes over blocks), `fullrate` (single samples: spectra, innovations, tails), `facts` (what
/// a file shows by itself: resampled rows, copied blocks), `consistency` (recordings held against each other and
/// against their references: gains, clocks), `causes` (one file each), `search` (which of them, in which order) and
/// `report` (sentences, checks, figures).
#include "core/investigate/report/report.hpp"
#include "core/investigate/study/study.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"

#include <cstddef>

namespace driftlab::investigate {

/// Channels whose searches go on side by side, in studies of at most so many rows: each takes its memory. Chosen, not
/// measured: the axes of a sensor.
inline constexpr std::size_t kSideBySide = 3;
inline constexpr std::size_t kMostRowsSideBySide = 400'000;

struct InvestigateOptions {
  bool predict_outages = true;  ///< half a second more
};

/// Errors: Cancelled; TooFewSamples where the study holds no recording. A channel that cannot be examined is no error:
/// the report says so. Deterministic.
[[nodiscard]] Result<Report> investigate(const Study& study, const InvestigateOptions& options = {},
                                         const RunControl& control = {});

}  // namespace driftlab::investigate
