#include "server/jobs/pool_results.hpp"

#include "schema/json/campaign_summary.hpp"
#include "schema/json/pooled_sensor.hpp"
#include "schema/json/reported_channel.hpp"

#include <algorithm>
#include <tuple>

namespace driftlab::server {
namespace {

/// One sensor axis of one device that the job touched.
struct Axis {
  std::string device_id;
  std::string quantity;
  std::string axis;
  friend bool operator<(const Axis& a, const Axis& b) {
    return std::tie(a.device_id, a.quantity, a.axis) < std::tie(b.device_id, b.quantity, b.axis);
  }
  friend bool operator==(const Axis& a, const Axis& b) = default;
};

std::vector<Axis> touched(const JobResults& results) {
  std::vector<Axis> axes;
  for (const ChannelResult& channel : results.channels) {
    if (!channel.axis.empty()) {  // channels that nobody named by axis are not the same sensor in two recordings
      axes.push_back({channel.device_id, channel.quantity, channel.axis});
    }
  }
  std::sort(axes.begin(), axes.end());
  axes.erase(std::unique(axes.begin(), axes.end()), axes.end());
  return axes;
}

Result<TableSource> source_of(const ChannelResult& channel) {
  auto read = parse_json(channel.document_json).and_then(reported_channel_from_json);
  if (!read) {
    return fail(read.error());
  }
  return TableSource{channel.recording_id, channel.condition, std::move(*read), channel.id};
}

/// The latest results of the axis once the job is done.
Result<std::vector<TableSource>> sources_of(const Axis& axis, JobContext& context, const JobResults& results) {
  auto stored = context.store.latest_channel_results(axis.device_id, axis.quantity, axis.axis);
  if (!stored) {
    return fail(stored.error());
  }
  std::erase_if(*stored, [&](const ChannelResult& old) {
    return std::any_of(results.channels.begin(), results.channels.end(), [&](const ChannelResult& mine) {
      return mine.recording_id == old.recording_id && mine.channel == old.channel;
    });
  });
  std::vector<TableSource> sources;
  const auto take = [&](const ChannelResult& channel) -> Status {
    auto source = source_of(channel);
    if (!source) {
      return fail(source.error());
    }
    sources.push_back(std::move(*source));
    return {};
  };
  for (const ChannelResult& channel : *stored) {
    if (auto taken = take(channel); !taken) {
      return fail(taken.error());
    }
  }
  for (const ChannelResult& mine : results.channels) {
    if (Axis{mine.device_id, mine.quantity, mine.axis} == axis) {
      if (auto taken = take(mine); !taken) {
        return fail(taken.error());
      }
    }
  }
  return sources;
}

/// The job's own sources with the ids under which they will be stored.
Result<std::vector<SensorSources>> own_sensors(const Json& document, const JobResults& results) {
  auto sensors = sensors_of(document);
  if (!sensors) {
    return sensors;
  }
  for (SensorSources& sensor : *sensors) {
    for (TableSource& source : sensor.sources) {
      const auto row = std::find_if(results.channels.begin(), results.channels.end(), [&](const ChannelResult& r) {
        return r.recording_id == source.recording_id && r.channel == source.channel.channel;
      });
      source.result_id = row == results.channels.end() ? "" : row->id;
    }
  }
  return sensors;
}

Status pool_axis(const Axis& axis, const Json& document, JobContext& context, const RunControl& control,
                 JobResults& results) {
  auto sources = sources_of(axis, context, results);
  auto older = context.store.pooled_result(axis.device_id, axis.quantity, axis.axis);
  if (!sources || !older) {
    return fail(sources ? older.error() : sources.error());
  }
  if (sources->size() < 2) {
    return {};
  }
  std::vector<PooledSensor> previous;
  auto own = pooled_of(document, {axis.quantity, axis.axis, {}});
  if (!own) {
    return fail(own.error());
  }
  if (*own) {
    previous.push_back(std::move(**own));
  }
  if (const auto& stored = *older) {
    if (auto parsed = parse_json(stored->document_json).and_then(pooled_sensor_from_json)) {
      previous.push_back(std::move(*parsed));
    }
  }
  const auto pooled = pool_sensor(*sources, previous, control);
  if (!pooled) {
    return fail(pooled.error());
  }
  results.pooled.push_back({axis.device_id, axis.quantity, axis.axis, to_text(to_json(*pooled))});
  return {};
}

}  // namespace

Status pool_results(Json& document, JobContext& context, const RunControl& control, JobResults& results) {
  const std::vector<Axis> axes = touched(results);
  const bool one_device = std::all_of(results.channels.begin(), results.channels.end(), [&](const ChannelResult& r) {
    return r.device_id == results.channels.front().device_id;
  });
  const RunControl first{control.stop,
                         [&](std::string_view stage, double fraction) { control.report(stage, 0.5 * fraction); }};
  if (one_device && !results.channels.empty()) {
    auto device = context.store.device(results.channels.front().device_id);
    if (!device) {
      return fail(device.error());
    }
    const auto sensors = own_sensors(document, results);
    const auto summary = sensors ? summarise_campaign(device->name, *sensors, first) : fail(sensors.error());
    if (!summary) {
      return fail(summary.error());
    }
    add_summary(document, *summary);
  } else {
    document["trends"] = Json::array();
    document["replicates"] = Json::array();
  }
  std::size_t done = 0;
  for (const Axis& axis : axes) {
    const RunControl part{
        control.stop, [&](std::string_view stage, double fraction) {
          control.report(stage, 0.5 + 0.5 * (static_cast<double>(done) + fraction) / static_cast<double>(axes.size()));
        }};
    if (auto pooled = pool_axis(axis, document, context, part, results); !pooled) {
      return pooled;
    }
    ++done;
  }
  return {};
}

}  // namespace driftlab::server
