#include "schema/json/campaign_summary.hpp"

#include "schema/json/pooled_sensor.hpp"
#include "schema/json/quality.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/reported_channel.hpp"
#include "schema/json/trend_table.hpp"

namespace driftlab {
namespace {

Result<std::vector<SensorSources>> read_sensors(const Json& characterisation) {
  std::vector<SensorSources> sensors;
  for (const Json& recording : characterisation.at("recordings")) {
    Faults ignored;
    const Quality quality = quality_from_json(recording.value("quality", Json()));
    const std::string condition = to_text(without_heading(condition_from_json(recording.at("condition"), "", ignored)));
    for (const Json& document : recording.at("channels")) {
      auto channel = reported_channel_from_json(document);
      if (!channel) {
        return fail(channel.error());
      }
      const std::size_t frozen = frozen_samples(quality, channel->channel);
      add_source(sensors, {recording.at("id").get<std::string>(), condition, std::move(*channel), "", frozen});
    }
  }
  return sensors;
}

}  // namespace

Result<std::vector<SensorSources>> sensors_of(const Json& characterisation) {
  try {
    return read_sensors(characterisation);
  } catch (const Json::exception& fault) {
    return fail(ErrorCode::Internal, "A characterisation cannot be read: " + std::string(fault.what()) + ".");
  }
}

void add_summary(Json& characterisation, const CampaignSummary& summary) {
  Json trends = Json::array();
  for (const TrendTable& table : summary.trends) {
    trends.push_back(to_json(table));
  }
  Json replicates = Json::array();
  for (const PooledSensor& pooled : summary.replicates) {
    replicates.push_back(to_json(pooled));
  }
  characterisation["trends"] = std::move(trends);
  characterisation["replicates"] = std::move(replicates);
}

Result<std::vector<PooledSensor>> pooled_sensors_of(const Json& characterisation) {
  std::vector<PooledSensor> sensors;
  for (const Json& document : characterisation.value("replicates", Json::array())) {
    auto pooled = pooled_sensor_from_json(document);
    if (!pooled) {
      return fail(pooled.error());
    }
    sensors.push_back(std::move(*pooled));
  }
  return sensors;
}

Result<std::vector<Remark>> remarks_of(const Json& characterisation) {
  std::vector<Remark> remarks;
  const auto add = [&](const std::string& whose, const Json& sentences) {
    for (const Json& sentence : sentences) {
      remarks.push_back({whose, sentence.get<std::string>()});
    }
  };
  try {
    for (const Json& recording : characterisation.at("recordings")) {
      const auto id = recording.at("id").get<std::string>();
      add(id, recording.at("quality").at("notes"));
      for (const Json& channel : recording.at("channels")) {
        add(id + ", " + channel.at("channel").get<std::string>(), channel.at("warnings"));
      }
    }
  } catch (const Json::exception& fault) {
    return fail(ErrorCode::Internal, "A characterisation cannot be read: " + std::string(fault.what()) + ".");
  }
  return remarks;
}

}  // namespace driftlab
