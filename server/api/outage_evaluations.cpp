/// Outage evaluations: jobs of kind `outage_evaluation` under a name of their own, with their results.
#include "schema/json/partial_outages.hpp"
#include "server/api/job_resource.hpp"

namespace driftlab::server {
namespace {

Json about_outages(const Json& request) {
  Json about = Json::object();
  const Json scenario = request.is_object() ? request["inputs"]["scenario"] : Json(nullptr);
  const bool named = scenario.is_string();
  about["scenario_name"] =
      named ? scenario : (scenario.is_object() && scenario.contains("name") ? scenario["name"] : Json(""));
  for (const char* const name : {"runs", "seed", "relative_precision"}) {
    about[name] = request.is_object() ? request["parameters"][name] : Json(nullptr);
  }
  return about;
}

const JobResource kOutageEvaluations{"outage_evaluation",
                                     "/v1/outage-evaluations",
                                     "outage evaluation",
                                     {"scenario"},
                                     {"runs", "seed", "relative_precision"},
                                     about_outages,
                                     partial_outages_json};

}  // namespace

void add_outage_evaluation_routes(Router& router, ApiContext& context) {
  router.add({"GET",
              "/v1/outage-evaluations",
              "listOutageEvaluations",
              {"limit", "cursor", "sort", "state", "q", "since"},
              Handler([&](const Request& request) { return list_job_objects(context, request, kOutageEvaluations); })});
  router.add({"POST", "/v1/outage-evaluations", "createOutageEvaluation", {}, Handler([&](const Request& request) {
                return create_job_object(context, request, kOutageEvaluations);
              })});
  router.add({"GET", "/v1/outage-evaluations/{id}", "getOutageEvaluation", {}, Handler([&](const Request& request) {
                return get_job_object(context, request, kOutageEvaluations);
              })});
}

}  // namespace driftlab::server
