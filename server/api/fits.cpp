#include "server/api/api.hpp"
#include "server/api/documents.hpp"

namespace driftlab::server {
namespace {

std::optional<std::string> text_parameter(const Request& request, std::string_view name) {
  const auto value = request.parameter(name);
  return value ? std::optional<std::string>(*value) : std::nullopt;
}

Result<Response> list_fits(ApiContext& context, const Request& request) {
  FitFilter filter;
  auto device_id = device_filter(context.store, request);
  if (!device_id) {
    return fail(device_id.error());
  }
  filter.device_id = std::move(*device_id);
  filter.recording_id = text_parameter(request, "recording");
  filter.job_id = text_parameter(request, "job");
  filter.quantity = text_parameter(request, "quantity");
  filter.axis = text_parameter(request, "axis");
  filter.model = text_parameter(request, "model");
  if (const auto best = request.parameter("best")) {
    if (*best != "true" && *best != "false") {
      return fail(ErrorCode::InvalidArgument, "The parameter best is true or false.", {{"parameter", "best"}});
    }
    filter.best_only = *best == "true";
  }
  return list_rows(
      request, [&](const Page& page) { return context.store.fits(filter, page); },
      [](const Fit& fit) { return to_json(fit); });
}

Result<Response> get_fit(ApiContext& context, const Request& request) {
  auto fit = context.store.fit(request.parameters[0]);
  if (!fit) {
    return fail(fit.error());
  }
  return json_response(200, to_json(*fit));
}

}  // namespace

void add_fit_routes(Router& router, ApiContext& context) {
  router.add(from_rows({"GET",
                        "/v1/fits",
                        "listFits",
                        {"limit", "cursor", "sort", "device", "recording", "job", "quantity", "axis", "model", "best"},
                        Handler([&](const Request& request) { return list_fits(context, request); })}));
  router.add(from_rows({"GET", "/v1/fits/{id}", "getFit", {}, Handler([&](const Request& request) {
                          return get_fit(context, request);
                        })}));
}

}  // namespace driftlab::server
