#pragma once
/// The effect of an investigation's findings on navigation: the position error after outages predicted by the baseline,
/// and the one predicted by the extended model.
///
/// Each studied axis has its model of the report, and those findings are added that a navigation simulation can
/// represent: slow processes, drift, quantization, lines and white noise as processes; scale factor, misalignment,
/// clipping, output step and band limit as properties of the unit; a turn-on bias as a wider constant bias. Every other
/// finding is left out and named. Axes that were not studied, the drive and the receiver are those of
/// `prediction_scenario` (core/navigate/outage_prediction.hpp).
#include "core/investigate/report/report.hpp"
#include "core/navigate/outage_prediction.hpp"

namespace driftlab::investigate {

/// Models of the studied axes before and after the findings.
struct SensorModels {
  SensorErrorModel baseline;
  SensorErrorModel extended;
  std::vector<std::string> left_out;  ///< "cause of channel", each once
};

/// `scenario` gives the constant biases, which an investigation does not judge, and the rate of the simulation. A
/// column is assigned to an axis of the unit by its quantity and axis; if two columns belong to one axis, the first is
/// used.
[[nodiscard]] SensorModels sensor_models(const Report& report, const std::vector<ChannelGroup>& groups,
                                         const OutageScenario& scenario);

/// Nothing where no studied column is an axis of a gyroscope or accelerometer. Deterministic. Errors: Cancelled.
[[nodiscard]] Result<std::optional<OutageGain>> outage_gain(const Report& report,
                                                            const std::vector<ChannelGroup>& groups,
                                                            const RunControl& control = {});

}  // namespace driftlab::investigate
