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
  auto pooled = store.pooled_result(device->id, quantity, wanted->axis);
  if (!pooled) {
    return fail(pooled.error());
  }
  std::vector<TableSource> sources;
  for (const ChannelResult& row : *rows) {
    sources.push_back({row.recording_id, row.condition, document_of(row.document_json), row.id});
  }
  const Json together = *pooled ? document_of((*pooled)->document_json) : Json();
  return build_parameter_table(*wanted, sources, together.is_object() ? &together : nullptr);
}

}  // namespace driftlab::server
