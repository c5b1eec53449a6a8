/// The route table: one line per resource, which names the function that adds its routes. Each is defined in the file
/// of its resource.
#include "schema/contract.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"

#include <map>

// clang-format off
#define DRIFTLAB_RESOURCES(RESOURCE)    \
  RESOURCE(add_service_routes)          \
  RESOURCE(add_device_routes)           \
  RESOURCE(add_recording_preview_routes) \
  RESOURCE(add_recording_routes)        \
  RESOURCE(add_recording_content_routes) \
  RESOURCE(add_upload_routes)           \
  RESOURCE(add_live_recording_routes)   \
  RESOURCE(add_characterisation_routes) \
  RESOURCE(add_trace_routes)            \
  RESOURCE(add_look_routes)             \
  RESOURCE(add_overview_routes)         \
  RESOURCE(add_search_routes)           \
  RESOURCE(add_sample_routes)           \
  RESOURCE(add_job_routes)              \
  RESOURCE(add_event_routes)            \
  RESOURCE(add_fit_routes)              \
  RESOURCE(add_parameter_table_routes)  \
  RESOURCE(add_structure_routes)        \
  RESOURCE(add_study_routes)            \
  RESOURCE(add_outage_evaluation_routes) \
  RESOURCE(add_drive_routes)            \
  RESOURCE(add_drive_evaluation_routes) \
  RESOURCE(add_calibration_routes)      \
  RESOURCE(add_investigation_routes)    \
  RESOURCE(add_model_routes)            \
  RESOURCE(add_regression_routes)       \
  RESOURCE(add_export_routes)           \
  RESOURCE(add_data_sheet_routes)       \
  RESOURCE(add_population_routes)       \
  RESOURCE(add_session_routes)          \
  RESOURCE(add_token_routes)            \
  RESOURCE(add_webhook_routes)          \
  RESOURCE(add_audit_routes)            \
  RESOURCE(add_backup_routes)
// clang-format on

namespace driftlab::server {

#define DRIFTLAB_DECLARE_RESOURCE(add) void add(Router& router, ApiContext& context);
DRIFTLAB_RESOURCES(DRIFTLAB_DECLARE_RESOURCE)
#undef DRIFTLAB_DECLARE_RESOURCE
void add_watch_routes(Router& router, ApiContext& context);

namespace {

/// What a token needs for each operation is `x-scope` in schema/openapi.yaml; an operation that does not say is for
/// admins.
void set_scopes_of_contract(Router& router) {
  const Json contract = stored(std::string(contract_file("openapi.json")));
  std::map<std::string, Scope, std::less<>> scopes;
  const Json paths = contract.value("paths", Json::object());
  for (const auto& [path, operations] : paths.items()) {
    for (const auto& [method, operation] : operations.items()) {
      scopes[operation.value("operationId", "")] = parse_scope(operation.value("x-scope", "")).value_or(Scope::Admin);
    }
  }
  router.set_scopes([&](std::string_view operation_id) {
    const auto found = scopes.find(operation_id);
    return found == scopes.end() ? Scope::Admin : found->second;
  });
}

}  // namespace

void add_health_routes(Router& router, ApiContext& context) {
  add_watch_routes(router, context);
  set_scopes_of_contract(router);
}

void add_all_routes(Router& router, ApiContext& context) {
#define DRIFTLAB_ADD_RESOURCE(add) add(router, context);
  DRIFTLAB_RESOURCES(DRIFTLAB_ADD_RESOURCE)
#undef DRIFTLAB_ADD_RESOURCE
  set_scopes_of_contract(router);
}

}  // namespace driftlab::server
