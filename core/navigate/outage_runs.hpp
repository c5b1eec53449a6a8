#pragma once
/// The runs behind an outage evaluation, for those who want every score instead of means.
#include "core/navigate/outage_evaluation.hpp"

namespace driftlab {

/// A scenario made ready: its truth and the designs of its filters. Immutable; shared by threads.
class OutageExperiment {
 public:
  /// Errors: as evaluate_outages; Cancelled.
  [[nodiscard]] static Result<OutageExperiment> make(const OutageScenario& scenario, const std::stop_token& stop = {});

  [[nodiscard]] const OutageScenario& scenario() const { return scenario_; }
  [[nodiscard]] const Trajectory& truth() const { return truth_; }
  [[nodiscard]] const FilterDesign& design(std::size_t filter) const { return designs_[filter]; }

  /// One run: scores[filter][outage]. `drawn`, where given, is filled. An empty result: stopped.
  [[nodiscard]] std::vector<std::vector<OutageScore>> run(std::uint64_t seed, std::uint64_t index, DrawnRun* drawn,
                                                          const std::stop_token& stop = {}) const;
  /// The fixes of a run.
  [[nodiscard]] std::vector<GnssFix> fixes(std::uint64_t seed, std::uint64_t index) const;
  /// The truth once a second, in metres from the start.
  [[nodiscard]] OutagePath true_path() const;
  /// The truth around each outage.
  [[nodiscard]] std::vector<OutagePath> true_tracks() const;

 private:
  OutageScenario scenario_;
  Trajectory truth_;
  std::vector<FilterDesign> designs_;
};

}  // namespace driftlab
