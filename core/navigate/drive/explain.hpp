#pragma once
/// Why a simulation of a drive is too optimistic, by profile likelihood (spec/drives.md, section 6).
///
/// The search starts from the level of white noise at which the innovations fit best, because at another level the
/// scores have no scale. Every knob (causes/cause.hpp) is then turned by -h and +h and the parabola through the three
/// log likelihoods gives estimate, uncertainty and score; where the likelihood still rises the step is doubled until it
/// falls. The knob with the best score is set, those found before and the noise level are fitted again, and the search
/// goes on until no knob has a score of 5 at three standard errors. Two whose scores differ by less than 2 are reported
/// as a pair. At the end all knobs go to the top of the likelihood together, and each standard error leaves the others
/// as uncertain as they are (joint_top.hpp). What is below a score of 5 or three of these errors then is taken out
/// again: until the last cause is set, its effect stands in the values of those before it (a heading at the start wrong
/// by 79 deg, until a clock was known).
///
/// Causes that the files show without a filter (velocities older than positions) are found first.
///
/// A cause that was found need not improve the filter. Its values are fitted once more on every second stretch of
/// 100 s, and the gain of the mended model is measured on the outages that lie entirely in the other stretches. A
/// parameter stays in the extended model if the held-out outages are then described better (Gaussian log score, in
/// which error and coverage both count).
///
/// Runs are tasks of the executor; results do not depend on the number of threads.
#include "core/navigate/drive/causes/cause.hpp"
#include "core/navigate/drive/likelihood.hpp"
#include "core/navigate/drive/simulation.hpp"

namespace driftlab::drive {

/// Errors of one duration, on the outages to which the model's values were fitted and on the held-out ones.
struct RungFigures {
  double duration_s = 0.0;
  std::size_t found_count = 0, held_out_count = 0;
  double found_rms_m = 0.0, found_nees = 0.0;
  double held_out_rms_m = 0.0, held_out_median_m = 0.0, held_out_nees = 0.0;
  double held_out_coverage50 = 0.0;
  Estimate held_out_coverage95;
  double held_out_log_score = 0.0;  ///< mean of -(ln |P| + e^T P^-1 e)/2
};

/// One step of the repair: the model with this finding and all before it.
struct Rung {
  std::string name;
  bool kept = true;
  std::vector<RungFigures> durations;
};

struct ExplainOptions {
  std::uint64_t seed = 1;
  int simulated_runs = 3;
  bool constraint = false;  ///< velocity constraints in every filter
  int most_causes = 10;
};

struct DriveExplanation {
  std::vector<DriveFinding> findings;  ///< in the order in which they were named
  std::vector<Rung> rungs;
  FilterOptions extended;                      ///< the mended model
  double gyro_noise = 1.0, force_noise = 1.0;  ///< factors of the extended model
  DriveEvaluation before;                      ///< the document's model, as stamped
  DriveEvaluation after;                       ///< the extended model
  std::vector<SimulatedDuration> simulated_before, simulated_after;
  std::vector<std::string> notes;
};

/// `as_stamped`: the same drive loaded without repairs. Errors: those of evaluate_drive; InvalidArgument for a
/// constraint on a vehicle that does not move along its nose; Cancelled.
[[nodiscard]] Result<DriveExplanation> explain_drive(const Drive& drive, const Drive& as_stamped,
                                                     const ExplainOptions& options = {},
                                                     const RunControl& control = {});

/// The search alone, on the innovations of the folds that `used` marks. It starts from `options` and leaves its result
/// there. With `only`, the given causes are fitted and no new one is named.
struct SearchResult {
  FilterOptions options;
  std::vector<DriveFinding> findings;
  double mean_square = 1.0;
};
[[nodiscard]] Result<SearchResult> search_causes(const Drive& drive, const FilterOptions& options, int most_causes,
                                                 const RunControl& control = {});

}  // namespace driftlab::drive
