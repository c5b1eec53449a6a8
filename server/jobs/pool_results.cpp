#include "server/jobs/pool_results.hpp"

#include "schema/json/pooled_sensor.hpp"

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
  auto document = parse_json(channel.document_json);
  if (!document) {
    return fail(document.error());
  }
  return TableSource{channel.recording_id, channel.condition, std::move(*document), channel.id};
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
std::vector<SensorSources> own_sensors(const Json& document, const JobResults& results) {
  std::vector<SensorSources> sensors = sensors_of(document);
  for (SensorSources& sensor : sensors) {
    for (TableSource& source : sensor.sources) {
      const auto row = std::find_if(results.channels.begin(), results.channels.end(), [&](const ChannelResult& r) {
        return r.recording_id == source.recording_id && r.channel == source.channel.value("channel", "");
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
  std::vector<Json> previous;
  const SensorSources sensor{axis.quantity, axis.axis, {}};
  if (const Json* const own = pooled_of(document, sensor)) {
    previous.push_back(*own);
  }
  if (const auto& stored = *older) {
    if (auto parsed = parse_json(stored->document_json)) {
      previous.push_back(std::move(*parsed));
    }
  }
  auto pooled = pool_sensor(*sources, previous, control);
  if (pooled) {
    results.pooled.push_back({axis.device_id, axis.quantity, axis.axis, to_text(*pooled)});
    return {};
  }
  // What cannot be put together (units that do not convert) stays apart: the table then says why.
  return pooled.error().code == ErrorCode::Cancelled ? fail(pooled.error()) : Status{};
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
    if (auto added = add_summary(document, device->name, own_sensors(document, results), first); !added) {
      return added;
    }
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
