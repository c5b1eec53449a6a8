#include "server/jobs/stored_baseline.hpp"

namespace driftlab::server {
namespace {

Result<Json> look_up(std::string_view kind, const std::string& id, Store& store) {
  if (kind == "model") {
    auto model = store.model(id);
    return model ? parse_json(model->document_json) : fail(model.error());
  }
  auto fit = store.fit(id);
  if (!fit) {
    return fail(fit.error());
  }
  auto document = parse_json(fit->document_json);
  if (!document) {
    return fail(document.error());
  }
  return Json{{"processes", document->value("processes", Json::array())}};
}

}  // namespace

Result<Json> stored_baseline(const Json& baseline, Store& store, const std::string& pointer, Faults& faults) {
  if (!baseline.is_object() || !baseline.contains("id")) {
    return baseline;
  }
  ObjectReader reader(baseline, pointer, faults);
  const std::string kind = reader.required_text("kind");
  const std::string id = reader.required_text("id");
  const Json* const channels = reader.member("channels");
  reader.reject_unknown();
  if (kind != "model" && kind != "fit") {
    faults.add(pointer + "/kind", ErrorCode::InvalidArgument, "What is stored is a \"model\" or a \"fit\".");
    return Json{{"kind", "auto"}};
  }
  auto found = look_up(kind, id, store);
  if (!found) {
    if (found.error().code != ErrorCode::NotFound) {
      return fail(found.error());
    }
    faults.add(pointer + "/id", ErrorCode::NotFound, "There is no " + kind + " " + id + ".");
    return Json{{"kind", "auto"}};
  }
  Json document = std::move(*found);
  document["kind"] = "model";
  if (channels != nullptr) {
    document["channels"] = *channels;
  }
  return document;
}

}  // namespace driftlab::server
