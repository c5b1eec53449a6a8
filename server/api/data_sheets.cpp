// What manufacturers state of their sensors.
#include "schema/json/data_sheet.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"

namespace driftlab::server {

void add_data_sheet_routes(Router& router, ApiContext& /*context*/) {
  router.add(
      {"GET", "/v1/data-sheets", "listDataSheets", {"model"}, Handler([](const Request& request) -> Result<Response> {
         const auto model = request.parameter("model");
         return json_response(200, data_sheets_document(model ? sheets_named_in(*model) : data_sheets()));
       })});
}

}  // namespace driftlab::server
