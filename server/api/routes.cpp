/// The route table: one line per resource, which names the function that adds its routes. Each is defined in the file
/// of its resource.
#include "server/api/api.hpp"

// clang-format off
#define DRIFTLAB_RESOURCES(RESOURCE)    \
  RESOURCE(add_service_routes)          \
  RESOURCE(add_device_routes)           \
  RESOURCE(add_recording_routes)        \
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
  RESOURCE(add_study_routes)            \
  RESOURCE(add_outage_evaluation_routes) \
  RESOURCE(add_calibration_routes)      \
  RESOURCE(add_investigation_routes)    \
  RESOURCE(add_model_routes)            \
  RESOURCE(add_regression_routes)       \
  RESOURCE(add_export_routes)
// clang-format on

namespace driftlab::server {

#define DRIFTLAB_DECLARE_RESOURCE(add) void add(Router& router, ApiContext& context);
DRIFTLAB_RESOURCES(DRIFTLAB_DECLARE_RESOURCE)
#undef DRIFTLAB_DECLARE_RESOURCE

void add_all_routes(Router& router, ApiContext& context) {
#define DRIFTLAB_ADD_RESOURCE(add) add(router, context);
  DRIFTLAB_RESOURCES(DRIFTLAB_ADD_RESOURCE)
#undef DRIFTLAB_ADD_RESOURCE
}

}  // namespace driftlab::server
