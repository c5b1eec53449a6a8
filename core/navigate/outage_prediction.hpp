#pragma once
/// The effect of a better error model on navigation: the position error after outages as predicted by a baseline model
/// and by an extended model.
///
/// Three mean horizontal errors at the end of the scenario's outages are computed by Monte Carlo simulation:
///   baseline   data from the baseline model, filter designed for it: the performance that was promised;
///   extended   data from the extended model, same filter: the performance in the field if the extended model is right;
///   adopted    data from the extended model, filter designed for it: the performance once it is adopted.
/// `extended` and `adopted` use the same data (common random numbers), so their difference is known far better than
/// either. `baseline` uses the same fixes, first estimates and random numbers with the other parameters.
///
/// A model is given for the channels that were studied; every other channel keeps the error model of the scenario.
/// Processes without a state space (`left_out`) are in the data but not in the filters. Effects of a study that are not
/// processes (bias, scale factor, misalignment, quantization, clipping, bandwidth) go into `hardware`. They are in the
/// data alone, because a filter estimates at most a constant bias.
#include "core/navigate/outage_evaluation.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// The error model of some channels, in the order of ImuSample (gyroscope x, y, z, accelerometer x, y, z).
struct SensorErrorModel {
  std::array<std::optional<AxisModel>, kImuChannels> axes;
  ImuHardware hardware;
};

struct PredictionOptions {
  int runs = 40;  ///< 2 to 100 000
  std::uint64_t seed = 1;
};

struct OutagePrediction {
  Estimate baseline_m;
  Estimate extended_m;
  Estimate adopted_m;
  Estimate adoption_gain_m;  ///< adopted minus extended, paired: negative where adopting the model helps
  int runs = 0;
  std::vector<std::string> left_out;  ///< names of the processes that the filters lack
};

/// The first two turns of the paper's drive with an outage of 10 s over each, the paper's accelerometers and receiver,
/// at 20 Hz: 3.5 minutes, of which a filter takes some milliseconds.
[[nodiscard]] OutageScenario prediction_scenario();

/// From `scenario` the receiver, the drive, the outages, the first estimate and the models of channels that are not
/// given are used; its filters are not. One run costs three filters over the drive; with `prediction_scenario` 40 runs
/// take about half a second. The result is the same for any number of threads. Errors: those of evaluate_outages;
/// Cancelled.
[[nodiscard]] Result<OutagePrediction> predict_outage_errors(const SensorErrorModel& baseline,
                                                             const SensorErrorModel& extended,
                                                             const OutageScenario& scenario = prediction_scenario(),
                                                             const PredictionOptions& options = {},
                                                             const RunControl& control = {});

}  // namespace driftlab
