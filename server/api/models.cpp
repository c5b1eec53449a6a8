#include "schema/json/simulation_model.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/store/digest.hpp"

#include <array>

namespace driftlab::server {
namespace {

constexpr std::array kMembers{"processes", "channels", "deterministic", "effects", "unnamed"};

Json to_json(const Model& model) {
  Json document{{"id", model.id},
                {"parent", model.parent_id.empty() ? Json(nullptr) : Json(model.parent_id)},
                {"device", model.device_id.empty() ? Json(nullptr) : Json(model.device_id)},
                {"name", model.name},
                {"processes", Json::array()},
                {"deterministic", Json::object()},
                {"effects", Json::array()}};
  const Json content = stored(model.document_json);
  for (const char* const member : kMembers) {
    if (content.contains(member)) {
      document[member] = content[member];
    }
  }
  document["provenance"] = stored(model.provenance_json);
  document["created_at"] = rfc3339(model.created_at);
  return document;
}

Result<Response> list_models(ApiContext& context, const Request& request) {
  ModelFilter filter;
  auto device_id = device_filter(context.store, request);
  if (!device_id) {
    return fail(device_id.error());
  }
  filter.device_id = std::move(*device_id);
  if (const auto parent = request.parameter("parent")) {
    filter.parent_id = *parent;
  }
  return list_rows(
      request, [&](const Page& page) { return context.store.models(filter, page); },
      [](const Model& model) { return to_json(model); });
}

Result<Response> get_model(ApiContext& context, const Request& request) {
  auto model = context.store.model(request.parameters[0]);
  if (!model) {
    return fail(model.error());
  }
  return json_response(200, to_json(*model));
}

Result<Response> create_model(ApiContext& context, const Request& request) {
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  ObjectReader reader(*body, "", faults);
  Model model;
  model.name = reader.required_text("name");
  model.parent_id = reader.text("parent").value_or("");
  const auto device_name = reader.text("device");
  const auto why = reader.text("why");
  limit_text(model.name, "name_bytes", request.budgets->name_bytes, reader.pointer("name"), faults);
  limit_text(why.value_or(""), "note_bytes", request.budgets->note_bytes, reader.pointer("why"), faults);
  Json content = Json::object();
  for (const char* const member : kMembers) {
    if (const Json* const value = reader.member(member)) {
      content[member] = *value;
      const bool list = member != std::string_view("channels") && member != std::string_view("deterministic");
      if (list ? !value->is_array() : !value->is_object()) {
        faults.add(reader.pointer(member), ErrorCode::ParseError, list ? "This is a list." : "This is an object.");
      }
    }
  }
  reader.reject_unknown();
  (void)simulation_model_from_json(content, "", faults);
  if (!faults.none()) {
    return fail(faults.error());
  }
  if (device_name) {
    auto device = context.store.device(*device_name);
    if (!device) {
      return fail(device.error());
    }
    model.device_id = device->id;
  }
  model.document_json = to_text(content);
  model.provenance_json = to_text(Json{{"made_by", "hand"}, {"why", why ? Json(*why) : Json(nullptr)}});
  model.unique_key = sha256_hex(canonical_text(*body));
  auto outcome = context.store.add_model(model);
  if (!outcome) {
    return fail(outcome.error());
  }
  Response response = json_response(outcome->created ? 201 : 200, to_json(outcome->model));
  response.headers.emplace_back("Location", "/v1/models/" + outcome->model.id);
  return response;
}

Result<Response> delete_model(ApiContext& context, const Request& request) {
  return remove_shown(request, get_model(context, request),
                      [&] { return context.store.remove_model(request.parameters[0]); });
}

}  // namespace

void add_model_routes(Router& router, ApiContext& context) {
  router.add(from_rows({"GET",
                        "/v1/models",
                        "listModels",
                        {"limit", "cursor", "sort", "device", "parent"},
                        Handler([&](const Request& request) { return list_models(context, request); })}));
  router.add({"POST", "/v1/models", "createModel", {}, Handler([&](const Request& request) {
                return create_model(context, request);
              })});
  router.add(from_rows({"GET", "/v1/models/{id}", "getModel", {}, Handler([&](const Request& request) {
                          return get_model(context, request);
                        })}));
  router.add({"DELETE", "/v1/models/{id}", "deleteModel", {}, Handler([&](const Request& request) {
                return delete_model(context, request);
              })});
}

}  // namespace driftlab::server
