#include "core/campaign/campaign_summary.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {

const PooledSensor* find_pooled(const std::vector<PooledSensor>& pooled, const SensorSources& sensor) {
  const auto found = std::find_if(pooled.begin(), pooled.end(), [&](const PooledSensor& one) {
    return one.quantity == sensor.quantity && one.sensor_axis == sensor.axis;
  });
  return found == pooled.end() ? nullptr : &*found;
}

Result<CampaignSummary> summarise_campaign(const std::string& device, const std::vector<SensorSources>& sensors,
                                           const RunControl& control) {
  CampaignSummary summary;
  std::size_t done = 0;
  for (const SensorSources& sensor : sensors) {
    const auto before = static_cast<double>(done++);
    const RunControl part{control.stop, [&](std::string_view stage, double fraction) {
                            control.report(stage, (before + fraction) / static_cast<double>(sensors.size()));
                          }};
    if (sensor.sources.size() < 2) {
      continue;
    }
    auto pooled = pool_sensor(sensor.sources, {}, part);
    if (!pooled) {
      return fail(pooled.error());
    }
    pooled->sensor_axis = sensor.axis;
    const Quantity quantity = parse_quantity(sensor.quantity).value_or(Quantity::Unspecified);
    for (const TableMethod method : {TableMethod::Av, TableMethod::Gmwm}) {
      const auto table = build_parameter_table({device, quantity, sensor.axis, method, ""}, sensor.sources, &*pooled);
      if (table) {
        summary.trends.push_back(build_trends(*table));
      }
    }
    summary.replicates.push_back(std::move(*pooled));
  }
  return summary;
}

}  // namespace driftlab
