#include "server/jobs/kept_table.hpp"

#include "schema/json/parameter_table.hpp"
#include "schema/json/stored_channel.hpp"
#include "schema/json/trend_table.hpp"
#include "server/jobs/stored_recordings.hpp"

#include <string_view>
#include <utility>

namespace driftlab::server {
namespace {

constexpr std::string_view kArtefact = "table";
/// What it holds.
constexpr const char* kTable = "table";
constexpr const char* kTrends = "trends";

/// What the table says beside the results: of the device, and in the words of this program.
Json surroundings_of(const Device& device) {
  return Json{{"version", DRIFTLAB_VERSION}, {"device", device.name}, {"hardware", hardware_of(device)}};
}

Json document_of(const ParameterTable& table) {
  Json document = to_json(table);
  document["summary"] = to_json(verdict_of(table));
  return document;
}

TableDocument document_of(const StoredTable& stored) { return {document_of(stored.table), stored.pooling}; }

/// A part of what was kept, where the request asks for just that.
std::optional<TableDocument> kept(Store& store, const StoredTableRequest& request, const char* part) {
  const auto quantity = quantity_of_sensor(request.sensor);
  if (!quantity || request.axis.empty() || !request.model.empty() || !request.reference.empty() ||
      parse_table_method(request.method) != TableMethod::Gmwm) {
    return std::nullopt;
  }
  const auto device = store.device(request.device);
  if (!device) {
    return std::nullopt;
  }
  // One that cannot be read is made from the results.
  const auto found = store.pooled_artefact({device->id, std::string(name_of(*quantity)), request.axis}, kArtefact);
  const std::optional<PooledArtefact> artefact = found.value_or(std::nullopt);
  if (!artefact) {
    return std::nullopt;
  }
  auto content = parse_json(artefact->content);
  if (!content || (*content)["of"] != surroundings_of(*device)) {
    return std::nullopt;
  }
  return TableDocument{std::move((*content)[part]), {PoolingState::Done, artefact->job_id, ""}};
}

}  // namespace

std::optional<Artefact> keep_table(Store& store, const SensorAxis& axis, std::vector<TableSource> sources,
                                   const PooledSensor& pooled) {
  const auto device = store.device(axis.device_id);
  const auto quantity = parse_quantity(axis.quantity);
  if (!device || !quantity || !tell_frozen(store, sources)) {
    return std::nullopt;
  }
  TableRequest request;
  request.device = device->name;
  request.quantity = *quantity;
  request.axis = axis.axis;
  request.hardware = hardware_of(*device);
  const auto table = build_parameter_table(request, sources, &pooled);
  if (!table) {
    return std::nullopt;
  }
  return Artefact{std::string(kArtefact), to_text(Json{{"of", surroundings_of(*device)},
                                                       {kTable, document_of(*table)},
                                                       {kTrends, to_json(build_trends(*table))}})};
}

Result<TableDocument> table_document(Store& store, const StoredTableRequest& request) {
  if (auto document = kept(store, request, kTable)) {
    return std::move(*document);
  }
  return stored_table(store, request).map([](const StoredTable& stored) { return document_of(stored); });
}

Result<TableDocument> trends_document(Store& store, const StoredTableRequest& request) {
  if (auto document = kept(store, request, kTrends)) {
    return std::move(*document);
  }
  return stored_table(store, request).map([](const StoredTable& stored) {
    return TableDocument{to_json(build_trends(stored.table)), stored.pooling};
  });
}

Result<std::vector<TableDocument>> table_documents(Store& store, const StoredTableRequest& request) {
  const auto requests = requests_of_axes(store, request);
  if (!requests) {
    return fail(requests.error());
  }
  std::vector<TableDocument> documents;
  for (const StoredTableRequest& one : *requests) {
    auto document = table_document(store, one);
    if (!document) {
      return fail(document.error());
    }
    documents.push_back(std::move(*document));
  }
  return documents;
}

}  // namespace driftlab::server
