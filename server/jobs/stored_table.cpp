#include "server/jobs/stored_table.hpp"

#include "schema/json/parameter_table.hpp"

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

/// A document that was checked when it was written.
Json document_of(const std::string& text) {
  auto document = parse_json(text);
  return document ? std::move(*document) : Json();
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

Result<Json> stored_table(Store& store, const StoredTableRequest& request) {
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
    sources.push_back({row.recording_id, row.condition, document_of(row.document_json), row.id});
  }
  const std::optional<PooledResult>& fitted_together = *pooled;
  const Json together = fitted_together ? document_of(fitted_together->document_json) : Json();
  return build_parameter_table(*wanted, sources, together.is_object() ? &together : nullptr);
}

}  // namespace driftlab::server
