#pragma once
/// The value of an error model in navigation: filters compared through GNSS outages by Monte Carlo simulation.
///
/// Every run draws one set of sensor errors, fixes and initial errors, and every filter receives that same set (common
/// random numbers). Differences between filters are therefore known far better than the errors themselves. At the end
/// of each outage, before the first returning fix, four things are scored: the horizontal position error; its
/// normalised square e^T P^-1 e (NEES, expected 2 if the filter's covariance P is right); whether the 50 and 95 %
/// ellipses of P contain the truth; heading and tilt errors.
///
/// Intervals are 95 % over runs by Student's t; the outages of one run are correlated and are averaged first.
/// Differences are paired by run; the interval of the relative difference (a - b)/b is by the delta method on the
/// pairs.
///
/// The result is deterministic: run r depends on (scenario, seed, r) alone, and sums are taken in order of r, whatever
/// the number of threads. A run of 8 minutes at 100 Hz costs about 20 ms for each filter.
#include "core/navigate/outage_scenario.hpp"
#include "core/signal/estimate.hpp"
#include "core/signal/progress.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace driftlab {

/// Changes whenever the same scenario and seed may give other numbers; stored with every result.
inline constexpr int kOutageAlgorithmVersion = 3;

struct OutageOptions {
  int runs = 400;  ///< at most; 2 to 100 000
  std::uint64_t seed = 1;
  /// Stops after a batch of 20 runs once every filter's mean error is known to this half-width, relative to it; 0:
  /// never.
  double relative_precision = 0.0;
  int scatter_runs = 200;  ///< errors of single runs kept in the result, for plotting
};

/// A filter at the end of one outage in one run.
struct OutageScore {
  double north_m = 0.0, east_m = 0.0;                            ///< estimate minus truth
  double var_north = 0.0, var_east = 0.0, cov_north_east = 0.0;  ///< what the filter expects [m^2]
  double heading_rad = 0.0;
  double tilt_rad = 0.0;
  [[nodiscard]] double error_m() const;
  [[nodiscard]] double nees() const;
};

/// Second moments of a cloud in the plane [m^2]; axes and direction of an ellipse follow from them.
struct PlaneCovariance {
  double north = 0.0, east = 0.0, north_east = 0.0;
};

/// Where a filter of the first run believed to be, or the truth was, in metres from the start.
struct OutagePath {
  std::vector<double> time_s, north_m, east_m;
};

/// Tracks hold ten points a second, from so long before an outage to so long after it.
inline constexpr double kTrackRateHz = 10.0;
inline constexpr double kTrackMarginS = 10.0;

struct OutageSummary {
  std::size_t index = 1;  ///< from 1
  double start_s = 0.0, end_s = 0.0;
  Estimate error_m;
  double rms_m = 0.0, median_m = 0.0, p95_m = 0.0;
  Estimate nees;
  double coverage50 = 0.0, coverage95 = 0.0;
  double heading_rms_rad = 0.0, tilt_rms_rad = 0.0;
  PlaneCovariance predicted;  ///< mean of the filter's own
  PlaneCovariance actual;     ///< second moments of the errors
  double mean_north_m = 0.0, mean_east_m = 0.0;
  std::vector<std::array<double, 2>> scatter;  ///< north, east of the first runs
  OutagePath track;                            ///< of the first run, around the outage
};

struct FilterEvaluation {
  std::string name, about;
  int states = 0;
  Estimate mean_error_m;  ///< over all outages
  Estimate nees;
  double coverage50 = 0.0, coverage95 = 0.0;
  double heading_rms_rad = 0.0, tilt_rms_rad = 0.0;
  std::vector<OutageSummary> outages;
  OutagePath path;  ///< once a second
};

/// `filter` minus `against` over the same runs.
struct PairedDifference {
  std::string filter, against;
  Estimate difference_m;
  Estimate relative;
  std::vector<Estimate> by_outage_m;
};

struct OutageEvaluation {
  std::string scenario;
  int runs = 0;
  std::uint64_t seed = 1;
  bool stopped_early = false;
  std::vector<FilterEvaluation> filters;
  std::vector<PairedDifference> paired;  ///< every pair of filters, in both orders
  OutagePath truth;                      ///< once a second
  std::vector<OutagePath> true_tracks;   ///< around each outage

  /// The pair in the order asked for; nothing where a name is missing.
  [[nodiscard]] std::optional<PairedDifference> difference(std::string_view filter, std::string_view against) const;
};

/// What is drawn of the first run: for each filter its path, and its track around each outage.
struct DrawnRun {
  std::vector<OutagePath> paths;
  std::vector<std::vector<OutagePath>> tracks;  ///< [filter][outage]
};

/// Consecutive runs of an evaluation: what one of several computers that share it works out at a time.
struct OutageBatch {
  std::vector<std::vector<std::vector<OutageScore>>> scores;  ///< [run][filter][outage]
  DrawnRun drawn;                                             ///< of the first batch alone
};

/// An evaluation in batches: `run` gives the same batch wherever and whenever it is called, `add` takes them in order.
class OutageBatches {
 public:
  /// Errors: those of evaluate_outages.
  [[nodiscard]] static Result<OutageBatches> make(const OutageScenario& scenario, const OutageOptions& options,
                                                  const std::stop_token& stop = {});
  OutageBatches(OutageBatches&&) noexcept;
  OutageBatches& operator=(OutageBatches&&) noexcept;
  OutageBatches(const OutageBatches&) = delete;
  OutageBatches& operator=(const OutageBatches&) = delete;
  ~OutageBatches();

  /// At most so many.
  [[nodiscard]] std::size_t count() const;
  /// Its runs are tasks of `control.threads`. Progress runs from 0 to 1. Errors: Cancelled.
  [[nodiscard]] Result<OutageBatch> run(std::size_t number, const RunControl& control) const;
  /// Takes the next batch. False: it was the last, or the precision asked for is reached. Error: InvalidArgument for
  /// one of another shape.
  [[nodiscard]] Result<bool> add(OutageBatch batch);
  /// What is known after the batches taken so far, as the stage of those that follow; new about ten times.
  [[nodiscard]] const std::string& stage() const;
  /// What the batches taken come to: one at least.
  [[nodiscard]] OutageEvaluation evaluate() const;

 private:
  struct State;
  explicit OutageBatches(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

/// Batch by batch; what is known so far is the name of the stage. Errors: those of
/// check(scenario), of the trajectory and of FilterDesign; Cancelled.
[[nodiscard]] Result<OutageEvaluation> evaluate_outages(const OutageScenario& scenario,
                                                        const OutageOptions& options = {},
                                                        const RunControl& control = {});

}  // namespace driftlab
