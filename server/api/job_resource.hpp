#pragma once
/// Resources whose objects are jobs of one kind under a name of their own, with their results: outage evaluations,
/// drive evaluations.
#include "schema/json/json.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"

#include <vector>

namespace driftlab::server {

struct JobResource {
  std::string_view kind;                ///< of its jobs
  std::string_view path;                ///< "/v1/outage-evaluations"
  std::string_view noun;                ///< "outage evaluation"
  std::vector<const char*> inputs;      ///< members of a request that are the job's inputs
  std::vector<const char*> parameters;  ///< and those that are its parameters
  /// Members that say what was asked, from a job's request, which may be null.
  Json (*about)(const Json& request);
  /// What is known while a job runs, by its stage; null: nothing is told of this kind.
  Json (*partial)(std::string_view stage) = nullptr;
};

/// Queues the job that a body of inputs, parameters and `priority` asks for. 202, or 200 for one that exists.
[[nodiscard]] Result<Response> create_job_object(ApiContext& context, const Request& request,
                                                 const JobResource& resource);
/// A page of the jobs, without their results.
[[nodiscard]] Result<Response> list_job_objects(ApiContext& context, const Request& request,
                                                const JobResource& resource);
/// One with `evaluation`, null until it has succeeded, and with `partial` while it runs.
[[nodiscard]] Result<Response> get_job_object(ApiContext& context, const Request& request, const JobResource& resource);

}  // namespace driftlab::server
