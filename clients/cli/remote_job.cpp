#include "clients/cli/remote_job.hpp"

#include "core/signal/number.hpp"

namespace driftlab::cli {
namespace {

/// Follows the job to its end. Events that stop early (a restarted daemon) are asked for again.
tl::expected<Json, Failure> wait_for(HttpClient& client, const std::string& job_id, ProgressBar& bar,
                                     double progress_before, double progress_after) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    auto followed = client.follow("/v1/jobs/" + job_id + "/events", [&](std::string_view data) {
      if (const auto event = parse_json(data); event && event->contains("progress")) {
        const Json& stage = (*event)["stage"];
        bar.show(stage.is_string() ? stage.get<std::string>() : event->value("state", ""),
                 progress_before + (progress_after - progress_before) * (*event)["progress"].get<double>());
      }
      return !interrupt_token().stop_requested();
    });
    if (interrupt_token().stop_requested()) {
      return tl::unexpected(Failure{
          {ErrorCode::Cancelled, "Interrupted; the job " + job_id + " goes on in the daemon.", {}}, Exit::Interrupted});
    }
    auto reply = client.get("/v1/jobs/" + job_id);
    if (!reply) {
      return unreachable(reply.error());
    }
    auto job = parse_json(reply->body);
    if (!job || !job->contains("state")) {
      return refused(*reply);
    }
    if ((*job)["state"] != "queued" && (*job)["state"] != "running") {
      return *job;
    }
  }
  return unreachable(Error{ErrorCode::Io, "The daemon does not say how job " + job_id + " is doing.", {}});
}

}  // namespace

tl::unexpected<Failure> unreachable(const Error& error) { return tl::unexpected(Failure{error, Exit::ServerOrJob}); }

tl::unexpected<Failure> refused(const HttpReply& reply) {
  auto problem = parse_json(reply.body);
  Error error{ErrorCode::Internal, "The daemon answered " + std::to_string(reply.status) + ".", {}};
  if (problem && problem->is_object() && problem->contains("detail")) {
    error.message = (*problem)["detail"].get<std::string>();
    const Json where = problem->value("where", Json::object());
    for (const auto& [name, value] : where.items()) {
      error.fields.push_back({name, value.is_string() ? value.get<std::string>() : to_text(value)});
    }
  }
  const bool users = reply.status >= 400 && reply.status < 500;
  return tl::unexpected(Failure{std::move(error), users ? Exit::BadInput : Exit::ServerOrJob});
}

tl::expected<Json, Failure> post_for_id(HttpClient& client, const std::string& target, const Json& document,
                                        const std::string& what) {
  auto reply = client.post(target, to_text(document));
  if (!reply) {
    return unreachable(reply.error());
  }
  if (reply->status < 200 || reply->status > 202) {
    return refused(*reply);
  }
  auto made = parse_json(reply->body);
  if (!made || !made->contains("id")) {
    return unreachable(Error{ErrorCode::ParseError, "The daemon's answer to " + what + " is not understood.", {}});
  }
  return (*made)["id"];
}

tl::expected<std::string, Failure> succeeded_job(HttpClient& client, const Json& request, ProgressBar& bar,
                                                 double progress_before, double progress_after) {
  auto queued = post_for_id(client, "/v1/jobs", request, "a job");
  if (!queued) {
    return tl::unexpected(queued.error());
  }
  std::string job_id = queued->get<std::string>();
  auto job = wait_for(client, job_id, bar, progress_before, progress_after);
  if (!job) {
    return tl::unexpected(job.error());
  }
  if ((*job)["state"] != "succeeded") {
    const Json problem = job->value("problem", Json());
    const std::string detail = problem.is_object() ? problem.value("detail", "") : "";
    return unreachable(Error{
        ErrorCode::Internal,
        "The job " + job_id + " ended " + (*job)["state"].get<std::string>() + (detail.empty() ? "." : ": " + detail),
        {}});
  }
  return job_id;
}

tl::expected<Json, Failure> run_job(HttpClient& client, const Json& request, ProgressBar& bar, double progress_before) {
  const auto job_id = succeeded_job(client, request, bar, progress_before);
  if (!job_id) {
    return tl::unexpected(job_id.error());
  }
  auto result = client.get("/v1/jobs/" + *job_id + "/result");
  if (!result) {
    return unreachable(result.error());
  }
  auto document = parse_json(result->body);
  if (result->status != 200 || !document) {
    return refused(*result);
  }
  return *document;
}

}  // namespace driftlab::cli
