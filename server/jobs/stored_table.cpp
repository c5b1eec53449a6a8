#include "server/jobs/stored_table.hpp"

#include "schema/json/campaign_summary.hpp"
#include "schema/json/pooled_sensor.hpp"
#include "schema/json/quality.hpp"
#include "server/jobs/axis_sources.hpp"
#include "server/jobs/stored_recordings.hpp"

#include <map>

namespace driftlab::server {
namespace {

Result<TableRequest> checked(const StoredTableRequest& wanted, const Device& device) {
  TableRequest table;
  table.device = device.name;
  auto quantity = quantity_of_sensor(wanted.sensor);
  if (!quantity) {
    return fail(Error(quantity.error()).with("parameter", "sensor"));
  }
  table.quantity = *quantity;
  table.axis = wanted.axis;
  if (!table.axis.empty() && !is_axis_of(table.axis, table.quantity)) {
    return fail(ErrorCode::InvalidArgument, "The axis must be x, y or z, not '" + table.axis + "'.",
                {{"parameter", "axis"}});
  }
  auto method = parse_table_method(wanted.method);
  if (!method) {
    return fail(method.error());
  }
  table.method = *method;
  table.model = wanted.model;
  if (!wanted.reference.empty()) {
    auto reference = parse_condition(wanted.reference);
    if (!reference) {
      return fail(Error(reference.error()).with("parameter", "reference"));
    }
    table.reference = *reference;
  }
  table.hardware = hardware_of(device);
  return table;
}

std::string reason_of(const Job& job) {
  if (job.state == JobState::Cancelled) {
    return "The job was cancelled.";
  }
  const auto problem = parse_json(job.problem_json);
  return problem && problem->is_object() ? problem->value("detail", std::string()) : std::string();
}

AxisPooling pooling_of(const AxisResults& results) {
  if (!results.pool) {
    return {};
  }
  const Job& job = *results.pool;
  if (!is_terminal(job.state)) {
    return {PoolingState::Pending, job.id, ""};
  }
  return job.state == JobState::Succeeded ? AxisPooling{PoolingState::Done, job.id, ""}
                                          : AxisPooling{PoolingState::Failed, job.id, reason_of(job)};
}

/// A sensor that has results, but only about axes, when no axis was named: which they are. Error: InvalidArgument.
Status check_axis_named(Store& store, const Device& device, const TableRequest& wanted) {
  const auto axes = store.axes_with_results(device.id, driftlab::name_of(wanted.quantity));
  if (!axes || axes->empty()) {
    return axes ? Status{} : fail(axes.error());
  }
  std::string present;
  for (const std::string& axis : *axes) {
    present.append(present.empty() ? "" : ", ").append(axis);
  }
  return fail(ErrorCode::InvalidArgument,
              "Name the axis; the " + std::string(sensor_of(wanted.quantity)) + " of device '" + device.name +
                  "' has results about " + present + ".",
              {{"parameter", "axis"}});
}

}  // namespace

Status tell_frozen(Store& store, std::vector<TableSource>& sources) {
  std::vector<std::string> ids;
  for (const TableSource& source : sources) {
    ids.push_back(source.recording_id);
  }
  const auto recordings = store.recordings_of(ids);
  if (!recordings) {
    return fail(recordings.error());
  }
  std::map<std::string_view, const Recording*> by_id;
  for (const Recording& recording : *recordings) {
    by_id[recording.id] = &recording;
  }
  for (TableSource& source : sources) {
    if (const auto found = by_id.find(source.recording_id); found != by_id.end()) {
      const auto quality = parse_json(found->second->quality_json);
      source.frozen = quality ? frozen_samples(quality_from_json(*quality), source.channel.channel) : 0;
    }
  }
  return {};
}

std::string_view name_of(PoolingState state) {
  switch (state) {
    case PoolingState::Pending:
      return "pending";
    case PoolingState::Failed:
      return "failed";
    case PoolingState::Done:
      break;
  }
  return "done";
}

Result<StoredTable> stored_table(Store& store, const StoredTableRequest& request) {
  auto device = store.device(request.device);
  if (!device) {
    return fail(device.error());
  }
  auto wanted = checked(request, *device);
  if (!wanted) {
    return fail(wanted.error());
  }
  auto results = store.axis_results({device->id, std::string(driftlab::name_of(wanted->quantity)), wanted->axis});
  if (!results) {
    return fail(results.error());
  }
  if (results->latest.empty() && wanted->axis.empty()) {
    if (auto named = check_axis_named(store, *device, *wanted); !named) {
      return fail(named.error());
    }
  }
  auto sources = sources_of(*results);
  if (!sources) {
    return fail(sources.error());
  }
  if (auto told = tell_frozen(store, *sources); !told) {
    return fail(told.error());
  }
  std::optional<PooledSensor> together;
  if (!results->pooled_json.empty()) {
    auto read = parse_json(results->pooled_json).and_then(pooled_sensor_from_json);
    if (!read) {
      return fail(read.error());
    }
    together = std::move(*read);
  }
  auto table = build_parameter_table(*wanted, *sources, together ? &*together : nullptr);
  if (!table) {
    return fail(table.error());
  }
  return StoredTable{std::move(*table), wanted->method == TableMethod::Gmwm ? pooling_of(*results) : AxisPooling{}};
}

Result<std::vector<StoredTableRequest>> requests_of_axes(Store& store, const StoredTableRequest& request) {
  StoredTableRequest one = request;
  one.axis.clear();
  auto device = store.device(request.device);
  if (!device) {
    return fail(device.error());
  }
  const auto wanted = checked(one, *device);
  if (!wanted) {
    return fail(wanted.error());
  }
  const auto axes = store.axes_with_results(device->id, driftlab::name_of(wanted->quantity));
  if (!axes) {
    return fail(axes.error());
  }
  if (axes->empty()) {
    return fail(ErrorCode::NotFound, "Device '" + device->name + "' has no characterised " +
                                         std::string(sensor_of(wanted->quantity)) +
                                         " about an axis; characterise a recording of it first.");
  }
  std::vector<StoredTableRequest> requests;
  for (const std::string& axis : *axes) {
    one.axis = axis;
    requests.push_back(one);
  }
  return requests;
}

Result<std::vector<StoredTable>> stored_tables(Store& store, const StoredTableRequest& request) {
  const auto requests = requests_of_axes(store, request);
  if (!requests) {
    return fail(requests.error());
  }
  std::vector<StoredTable> tables;
  for (const StoredTableRequest& one : *requests) {
    auto table = stored_table(store, one);
    if (!table) {
      return fail(table.error());
    }
    tables.push_back(std::move(*table));
  }
  return tables;
}

}  // namespace driftlab::server
