#pragma once
/// Simulation of a recorded drive's outages: the errors that the model predicts on the same trajectory with the same
/// outages.
///
/// The truth follows the attitude and velocity that the filter found along the recording. Readings are its ideal ones
/// with errors drawn from the model, fixes have the stated errors and describe the moment of their stamp, and the first
/// estimate is the truth plus a draw of its uncertainty: every assumption of the filter holds. A recorded attitude does
/// not point where the vehicle goes; this side slip belongs to the truth, and a velocity constraint measures it with
/// the white error that it believes in. So the simulation's own coverage is right with and without constraints, and a
/// measured error beyond it is due to an effect that the simulation lacks.
#include "core/navigate/drive/evaluation.hpp"

namespace driftlab::drive {

struct SimulationOptions {
  int runs = 4;  ///< simulated drives; each goes through every outage of the plan
  std::uint64_t seed = 1;
};

/// The model's errors beside the measured ones.
struct SimulatedDuration {
  double duration_s = 0.0;
  std::size_t count = 0;
  double rms_m = 0.0, mean_m = 0.0, median_m = 0.0;
  /// The coverage of the simulation's own filter; its interval resamples blocks of one period of one simulated drive.
  Estimate nees, coverage50, coverage95;
  /// Measured rms over simulated rms; blocks of the measured and of the simulated outages resampled, so that the
  /// interval holds the scatter of both.
  Estimate ratio;
  ErrorGrowth growth;
};

/// A drive simulated once: as load_drive would give it. `poses` on the drive's clock. Errors: those of
/// make_recorded_motion and make_trajectory.
class SimulatedWorld {
 public:
  /// `prepared`: the model under test, whose filter gives the trajectory.
  [[nodiscard]] static Result<SimulatedWorld> make(const PreparedDrive& prepared, std::size_t part);

  struct World {
    Drive drive;
    Start start;
    std::vector<std::array<double, 2>> slip;  ///< by reading
  };
  /// Draw `run` of `seed`. `truth_errors` are put into the readings, beside the model's.
  [[nodiscard]] World draw(std::uint64_t seed, std::uint64_t run, const ReadingErrors& truth_errors = {}) const;

  /// What the filter believes in the simulated world: the model's options without offsets and errors.
  [[nodiscard]] const FilterOptions& options() const { return options_; }
  [[nodiscard]] const Trajectory& truth() const { return truth_; }
  /// That of the recording, from the first simulated reading on.
  [[nodiscard]] const Vibration& vibration() const { return vibration_; }

 private:
  const Drive* recorded_ = nullptr;
  Start start_;
  FilterOptions options_;
  ImuModel believed_;  ///< what a filter is told of the unit whose errors are taken off
  ImuModel model_;     ///< the same with the levels that the options say
  Trajectory truth_;
  Vibration vibration_;
  double start_s_ = 0.0;
};

/// Outages simulated under the prepared model, beside `measured` ones of the same plan. Errors: as
/// SimulatedWorld::make; Cancelled.
[[nodiscard]] Result<std::vector<SimulatedDuration>> simulate_outages(const PreparedDrive& prepared,
                                                                      const std::vector<DurationSummary>& measured,
                                                                      const SimulationOptions& options,
                                                                      const RunControl& control = {});

}  // namespace driftlab::drive
