/// Drive evaluations: jobs of kind `drive_evaluation` under a name of their own, with their results.
#include "server/api/job_resource.hpp"

namespace driftlab::server {
namespace {

Json about_drive(const Json& request) {
  Json about{{"drive", nullptr}, {"name", nullptr}, {"question", nullptr}, {"seed", nullptr}};
  if (request.is_object()) {
    const Json& inputs = request["inputs"];
    about["drive"] = inputs["drive"];
    about["name"] = inputs["document"]["id"];
    about["question"] = request["parameters"]["question"];
    about["seed"] = request["parameters"]["seed"];
  }
  return about;
}

const JobResource kDriveEvaluations{"drive_evaluation",
                                    "/v1/drive-evaluations",
                                    "drive evaluation",
                                    {"drive", "model", "outages"},
                                    {"question", "velocity_constraint", "zero_velocity", "odometer", "gate",
                                     "as_stamped", "seed", "runs", "estimate", "models", "fit_noise"},
                                    about_drive};

}  // namespace

void add_drive_evaluation_routes(Router& router, ApiContext& context) {
  router.add({"GET",
              "/v1/drive-evaluations",
              "listDriveEvaluations",
              {"limit", "cursor", "sort", "state"},
              Handler([&](const Request& request) { return list_job_objects(context, request, kDriveEvaluations); })});
  router.add({"POST", "/v1/drive-evaluations", "createDriveEvaluation", {}, Handler([&](const Request& request) {
                return create_job_object(context, request, kDriveEvaluations);
              })});
  router.add({"GET", "/v1/drive-evaluations/{id}", "getDriveEvaluation", {}, Handler([&](const Request& request) {
                return get_job_object(context, request, kDriveEvaluations);
              })});
}

}  // namespace driftlab::server
