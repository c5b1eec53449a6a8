#include "clients/cli/analysis.hpp"
#include "clients/cli/http_client.hpp"
#include "clients/cli/progress.hpp"
#include "core/signal/number.hpp"
#include "schema/json/characterise_recording.hpp"
#include "schema/json/recording_spec.hpp"

namespace driftlab::cli {
namespace {

tl::unexpected<Failure> unreachable(const Error& error) { return tl::unexpected(Failure{error, Exit::ServerOrJob}); }

/// A problem document as an error; a client's fault (4xx) is the user's input, the rest the server's.
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

std::string columns_text(const std::map<std::string, ColumnRole>& columns) {
  std::string text;
  for (const auto& [name, role] : columns) {
    text += (text.empty() ? "" : ",") + name + "=" + std::string(name_of(role.quantity)) + ":" + role.axis;
    if (role.unit) {
      text += ":" + role.unit->symbol;
    }
  }
  return text;
}

std::string upload_target(const std::string& device, const RecordingSpec& spec) {
  std::string target = "/v1/recordings?device=" + percent_encode(device) +
                       "&condition=" + percent_encode(to_text(spec.condition)) + "&id=" + percent_encode(spec.id);
  if (spec.rate_hz) {
    target += "&rate_hz=" + to_text(*spec.rate_hz);
  }
  if (!spec.columns.empty()) {
    target += "&columns=" + percent_encode(columns_text(spec.columns));
  }
  if (spec.trim.start_s > 0.0) {
    target += "&trim_start_s=" + to_text(spec.trim.start_s);
  }
  if (spec.trim.end_s > 0.0) {
    target += "&trim_end_s=" + to_text(spec.trim.end_s);
  }
  if (!spec.calibration.empty()) {
    target += "&calibration=" + percent_encode(spec.calibration);
  }
  return target;
}

/// Posts a document and takes the id of what it made, `what`.
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

/// Stores the calibrations that files name in the daemon, and names those instead.
tl::expected<std::vector<InputFile>, Failure> with_stored_calibrations(HttpClient& client, const Inputs& inputs) {
  std::vector<InputFile> files = inputs.files;
  for (InputFile& file : files) {
    if (file.spec.calibration.empty()) {
      continue;
    }
    const Json request{{"device", {{"id", inputs.device}}}, {"calibration", file.calibration_document}};
    auto id = post_for_id(client, "/v1/calibrations", request, "a calibration");
    if (!id) {
      return tl::unexpected(id.error());
    }
    file.spec.calibration = id->get<std::string>();
  }
  return files;
}

/// What the job works on: the uploaded recordings, or where they are a study, that.
tl::expected<Json, Failure> job_inputs(HttpClient& client, const Inputs& inputs, const Json& ids) {
  if (!inputs.study.is_string()) {
    return Json{{"recordings", ids}};
  }
  Json study{{"device", {{"id", inputs.device}}}, {"recordings", Json::array()}};
  for (std::size_t i = 0; i < ids.size(); ++i) {
    study["recordings"].push_back(Json{{"recording", ids[i]}, {"id", inputs.files[i].spec.id}});
  }
  if (!inputs.baseline.is_null()) {
    study["baseline"] = inputs.baseline;
  }
  auto id = post_for_id(client, "/v1/studies", study, "a study");
  if (!id) {
    return tl::unexpected(id.error());
  }
  return Json{{"study", *id}};
}

/// The ids of the uploaded recordings, in order.
tl::expected<Json, Failure> upload_all(HttpClient& client, const Inputs& inputs, ProgressBar& bar) {
  auto files = with_stored_calibrations(client, inputs);
  if (!files) {
    return tl::unexpected(files.error());
  }
  Json ids = Json::array();
  for (const InputFile& file : *files) {
    const auto done = static_cast<double>(ids.size());
    auto reply = client.upload(upload_target(inputs.device, file.spec), file.path, [&](double fraction) {
      bar.show("upload " + file.spec.id, 0.3 * (done + fraction) / static_cast<double>(inputs.files.size()));
    });
    if (!reply) {
      const bool missing = reply.error().code == ErrorCode::NotFound;
      return tl::unexpected(Failure{reply.error(), missing ? Exit::BadInput : Exit::ServerOrJob});
    }
    if (reply->status != 200 && reply->status != 201) {
      auto failure = refused(*reply);
      failure.value().error.message = file.path.string() + ": " + failure.value().error.message;
      return failure;
    }
    auto recording = parse_json(reply->body);
    if (!recording || !recording->contains("id")) {
      return unreachable(Error{ErrorCode::ParseError, "The daemon's answer to an upload is not understood.", {}});
    }
    ids.push_back((*recording)["id"]);
  }
  return ids;
}

/// Follows the job to its end. Events that stop early (a restarted daemon) are asked for again.
tl::expected<Json, Failure> wait_for(HttpClient& client, const std::string& job_id, ProgressBar& bar) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    auto followed = client.follow("/v1/jobs/" + job_id + "/events", [&](std::string_view data) {
      if (const auto event = parse_json(data); event && event->contains("progress")) {
        const Json& stage = (*event)["stage"];
        bar.show(stage.is_string() ? stage.get<std::string>() : event->value("state", ""),
                 0.3 + 0.7 * (*event)["progress"].get<double>());
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

tl::expected<Json, Failure> characterise_there(const Inputs& inputs, const CharacteriseOptions& options,
                                               const std::string& server) {
  auto client = HttpClient::to(server);
  if (!client) {
    return tl::unexpected(Failure{client.error(), Exit::BadInput});
  }
  ProgressBar bar;
  auto ids = upload_all(*client, inputs, bar);
  if (!ids) {
    return tl::unexpected(ids.error());
  }
  auto wanted = job_inputs(*client, inputs, *ids);
  if (!wanted) {
    return tl::unexpected(wanted.error());
  }
  const Json request{{"kind", "characterise"}, {"inputs", *wanted}, {"parameters", to_json(options)}};
  auto queued = post_for_id(*client, "/v1/jobs", request, "a job");
  if (!queued) {
    return tl::unexpected(queued.error());
  }
  const auto job_id = queued->get<std::string>();
  auto job = wait_for(*client, job_id, bar);
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
  auto result = client->get("/v1/jobs/" + job_id + "/result");
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
