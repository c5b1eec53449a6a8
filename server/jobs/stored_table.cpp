#include "server/jobs/stored_table.hpp"

#include "schema/json/pooled_sensor.hpp"
#include "schema/json/reported_channel.hpp"

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
  return table;
}

/// A sensor that has results, but only about axes, when no axis was named: which they are. Error: InvalidArgument.
Status check_axis_named(Store& store, const Device& device, const TableRequest& wanted) {
  std::string present;
  for (const std::string_view axis : {"x", "y", "z"}) {
    auto rows = store.latest_channel_results(device.id, driftlab::name_of(wanted.quantity), axis);
    if (!rows) {
      return fail(rows.error());
    }
    if (!rows->empty()) {
      present.append(present.empty() ? "" : ", ").append(axis);
    }
  }
  if (present.empty()) {
    return {};
  }
  return fail(ErrorCode::InvalidArgument,
              "Name the axis; the " + std::string(sensor_of(wanted.quantity)) + " of device '" + device.name +
                  "' has results about " + present + ".",
              {{"parameter", "axis"}});
}

}  // namespace

Result<ParameterTable> stored_table(Store& store, const StoredTableRequest& request) {
  auto device = store.device(request.device);
  if (!device) {
    return fail(device.error());
  }
  auto wanted = checked(request, *device);
  if (!wanted) {
    return fail(wanted.error());
  }
  const std::string_view quantity = driftlab::name_of(wanted->quantity);
  auto rows = store.latest_channel_results(device->id, quantity, wanted->axis);
  if (!rows) {
    return fail(rows.error());
  }
  if (rows->empty() && wanted->axis.empty()) {
    if (auto named = check_axis_named(store, *device, *wanted); !named) {
      return fail(named.error());
    }
  }
  auto pooled = store.pooled_result(device->id, quantity, wanted->axis);
  if (!pooled) {
    return fail(pooled.error());
  }
  std::vector<TableSource> sources;
  for (const ChannelResult& row : *rows) {
    auto channel = parse_json(row.document_json).and_then(reported_channel_from_json);
    if (!channel) {
      return fail(channel.error());
    }
    sources.push_back({row.recording_id, row.condition, std::move(*channel), row.id});
  }
  if (!pooled->has_value()) {
    return build_parameter_table(*wanted, sources);
  }
  const auto together = parse_json((*pooled)->document_json).and_then(pooled_sensor_from_json);
  if (!together) {
    return fail(together.error());
  }
  return build_parameter_table(*wanted, sources, &*together);
}

}  // namespace driftlab::server
