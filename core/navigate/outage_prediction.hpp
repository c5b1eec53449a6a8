#pragma once
/// What a better error model says about navigation: the position error after outages, as a baseline and as an extended
/// model predict it.
///
/// Three mean horizontal errors at the end of the scenario's outages, by Monte Carlo:
///   baseline   data by the baseline model, a filter that believes it: what was promised;
///   extended   data by the extended model, the same filter: what the field will show where the extended model is
///   right; adopted    data by the extended model, a filter that believes it: what adopting the model leaves.
/// `extended` and `adopted` see the same data (common random numbers), so their difference is known far better than
/// either. `baseline` uses the same fixes, first estimates and random numbers with the other parameters.
///
/// A model is given for the channels that were studied; every other channel keeps the scenario's own error model.
/// Processes without a state space (`left_out`) are in the data and missing in the filters. What a study's effects
/// amount to beyond processes goes into `hardware` (bias, scale factor, misalignment, quantization, clipping,
/// bandwidth): in the data alone, for a filter estimates a constant bias at most.
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

/// `scenario`: its filters are not used; receiver, drive, outages, first estimate and the models of channels that are
/// not given are. One run costs three filters over the drive: with `prediction_scenario` 40 runs take about half a
/// second. Deterministic for any number of threads. Errors: those of evaluate_outages; Cancelled.
[[nodiscard]] Result<OutagePrediction> predict_outage_errors(const SensorErrorModel& baseline,
                                                             const SensorErrorModel& extended,
                                                             const OutageScenario& scenario = prediction_scenario(),
                                                             const PredictionOptions& options = {},
                                                             const RunControl& control = {});

}  // namespace driftlab
