#pragma once
/// The joint results of the recordings of one campaign: every sensor axis pooled, and the trends of its parameter
/// tables.
#include "core/campaign/pooled_sensor.hpp"
#include "core/campaign/trend_table.hpp"
#include "core/signal/progress.hpp"

#include <string>
#include <vector>

namespace driftlab {

struct CampaignSummary {
  std::vector<PooledSensor> replicates;  ///< of each axis with two recordings or more, `sensor_axis` named
  std::vector<TrendTable> trends;        ///< of the tables of these axes by both methods, where there is a table
};

/// The pooled result of a sensor axis, or nullptr where none was put together.
[[nodiscard]] const PooledSensor* find_pooled(const std::vector<PooledSensor>& pooled, const SensorSources& sensor);

/// Axes in the order given. Errors: those of pool_sensor.
[[nodiscard]] Result<CampaignSummary> summarise_campaign(const std::string& device,
                                                         const std::vector<SensorSources>& sensors,
                                                         const RunControl& control);

}  // namespace driftlab
