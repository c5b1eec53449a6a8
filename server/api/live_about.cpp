#include "server/api/live_about.hpp"

#include "schema/json/recording_spec.hpp"
#include "server/api/documents.hpp"

#include <limits>

namespace driftlab::server {
namespace {

const Budgets& budgets_of_what_began() {
  static const Budgets boundless = [] {
    Budgets budgets;
    for (std::int64_t* const limit : {&budgets.labels, &budgets.label_bytes, &budgets.name_bytes}) {
      *limit = std::numeric_limits<std::int64_t>::max();
    }
    return budgets;
  }();
  return boundless;
}

Json to_json(const Principal& principal) {
  return Json{{"token", principal.token},
              {"name", principal.name},
              {"scope", name_of(principal.scope)},
              {"devices", principal.devices ? Json(*principal.devices) : Json(nullptr)}};
}

}  // namespace

std::string live_about_text(const Json& given, const std::string& device, const std::vector<std::string>& columns,
                            UtcMicros now, const Principal& principal) {
  return to_text(Json{{"metadata", given},
                      {"device", device},
                      {"columns", columns},
                      {"created_at", now},
                      {"principal", to_json(principal)}});
}

Result<LiveAbout> about_of(const LiveRecording& recording) {
  const Json document = stored(recording.about_json);
  Request began;
  began.budgets = &budgets_of_what_began();
  auto metadata = metadata_from_json(to_text(document.at("metadata")), began);
  if (!metadata) {
    return fail(metadata.error());
  }
  return LiveAbout{std::move(*metadata), document.at("columns").get<std::vector<std::string>>()};
}

Unit unit_of(const LiveAbout& about, const std::string& column) {
  return about.metadata.spec.columns.at(column).unit.value_or(Unit{});
}

std::optional<Principal> principal_of(const LiveRecording& recording) {
  const Json about = stored(recording.about_json);
  if (!about.contains("principal")) {
    return std::nullopt;
  }
  const Json& kept = about.at("principal");
  Principal principal;
  principal.token = kept.at("token").get<std::string>();
  principal.name = kept.at("name").get<std::string>();
  principal.scope = parse_scope(kept.at("scope").get<std::string>()).value_or(Scope::Public);
  if (!kept.at("devices").is_null()) {
    principal.devices = kept.at("devices").get<std::vector<std::string>>();
  }
  return principal;
}

}  // namespace driftlab::server
