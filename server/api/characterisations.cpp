// The newest result of one recording, and what its fits and simulation models imply beside it.
#include "core/analysis/implied_model.hpp"
#include "schema/json/error_model.hpp"
#include "schema/json/reported_channel.hpp"
#include "schema/json/simulation_model.hpp"
#include "schema/json/stored_channel.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/api/newest_fits.hpp"
#include "server/http/problem.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

/// Where a job's document speaks of a recording: by its id, or by the name that a study gave it.
Result<Json> recording_in(const Json& document, const Job& job, const std::string& recording_id) {
  const Json request = stored(job.request_json);
  const Json& inputs = request.at("inputs").at("recordings");
  const Json& results = document.at("recordings");
  for (std::size_t i = 0; i < inputs.size() && i < results.size(); ++i) {
    if (inputs[i].at("id") == recording_id) {
      return results[i];
    }
  }
  return fail(ErrorCode::Internal,
              "The result of the job " + job.id + " does not hold the recording " + recording_id + ".");
}

struct Characterised {
  Job job;
  Json recording;  ///< its part of the job's document
};

Result<Characterised> result_of(ApiContext& context, const std::string& job_id, const std::string& recording_id) {
  auto job = context.store.job(job_id);
  if (!job) {
    return fail(job.error());
  }
  auto text = context.store.result_document(job_id);
  if (!text) {
    return fail(text.error());
  }
  auto part = recording_in(stored(*text), *job, recording_id);
  if (!part) {
    return fail(part.error());
  }
  return Characterised{std::move(*job), std::move(*part)};
}

/// One channel with the ids of its fits, what it says and what its best fit implies.
Result<Json> channel_document(const Json& channel, const std::vector<Fit>& fits) {
  const auto told = stored_channel_from_json(channel);
  if (!told) {
    return fail(told.error());
  }
  std::vector<std::string> ids(channel.at("fits").size());
  for (const Fit& fit : fits) {
    if (fit.channel == channel.at("channel").get<std::string>() && static_cast<std::size_t>(fit.rank) < ids.size()) {
      ids[static_cast<std::size_t>(fit.rank)] = fit.id;
    }
  }
  const auto implied = ids.empty() ? std::nullopt : implied_by(told->told.fits.front(), *told);
  return Json{{"summary", driftlab::to_json(verdict_of(*told))},
              {"fit_ids", ids},
              {"implied", implied ? driftlab::to_json(*implied, told->told.parsed_unit().symbol) : Json(nullptr)},
              {"result", channel}};
}

/// The newest result of a recording, and its fits.
struct NewestCharacterisation {
  Recording recording;
  std::vector<Fit> fits;
  Characterised found;
};

Result<NewestCharacterisation> newest_characterisation(ApiContext& context, const std::string& recording_id) {
  auto recording = context.store.recording(recording_id);
  if (!recording) {
    return fail(recording.error());
  }
  auto fits = newest_fits(context.store, recording->id);
  if (!fits) {
    return fail(fits.error());
  }
  if (fits->empty()) {
    return fail(not_characterised(recording->id));
  }
  auto found = result_of(context, fits->front().job_id, recording->id);
  if (!found) {
    return fail(found.error());
  }
  return NewestCharacterisation{std::move(*recording), std::move(*fits), std::move(*found)};
}

Result<Response> get_characterisation(ApiContext& context, const Request& request) {
  const auto newest = newest_characterisation(context, request.parameters[0]);
  if (!newest) {
    return fail(newest.error());
  }
  const auto& [recording, fits, found] = *newest;
  const auto wanted = request.parameter("channel");
  Json channels = Json::array();
  for (const Json& channel : found.recording.at("channels")) {
    if (wanted && channel.at("channel") != std::string(*wanted)) {
      continue;
    }
    auto document = channel_document(channel, fits);
    if (!document) {
      return fail(document.error());
    }
    channels.push_back(std::move(*document));
  }
  if (channels.empty()) {
    return fail(no_channel(recording.id, std::string(wanted.value_or(""))));
  }
  const Json asked = stored(found.job.request_json);
  const std::int64_t revision = fits.front().recording_revision;
  Json document{{"recording", recording.id},
                {"revision", revision},
                {"stale", revision != recording.revision},
                {"job", found.job.id},
                {"created_at", rfc3339(fits.front().created_at)},
                {"algorithm_version", asked.at("algorithm_version")},
                {"parameters", asked.at("parameters")},
                {"condition", found.recording.at("condition")},
                {"duration_s", found.recording.at("duration_s")},
                {"rate_hz", found.recording.at("rate_hz")}};
  document["channels"] = std::move(channels);
  return json_response(200, document);
}

Result<Response> get_implied(ApiContext& context, const Request& request) {
  auto fit = context.store.fit(request.parameters[0]);
  if (!fit) {
    return fail(fit.error());
  }
  auto found = result_of(context, fit->job_id, fit->recording_id);
  if (!found) {
    return fail(found.error());
  }
  for (const Json& channel : found->recording.at("channels")) {
    if (channel.at("channel") == fit->channel) {
      const auto told = stored_channel_from_json(channel);
      const auto asked = stored_fit_from_json(stored(fit->document_json));
      if (!told || !asked) {
        return fail(!told ? told.error() : asked.error());
      }
      const auto implied = implied_by(asked->fit, *told);
      if (!implied) {
        return fail(ErrorCode::NotFound, "The fit " + fit->id + " leaves a parameter open: it implies no curve.");
      }
      return json_response(200, Json{{"fit", fit->id},
                                     {"model", fit->model},
                                     {"implied", driftlab::to_json(*implied, told->told.parsed_unit().symbol)}});
    }
  }
  return fail(ErrorCode::Internal,
              "The result of the job " + fit->job_id + " does not hold the channel " + fit->channel + ".");
}

/// The part of the newest result of `recording_id` that is about that channel.
Result<StoredChannel> newest_channel(ApiContext& context, const std::string& recording_id, const std::string& name) {
  const auto newest = newest_characterisation(context, recording_id);
  if (!newest) {
    return fail(newest.error());
  }
  for (const Json& channel : newest->found.recording.at("channels")) {
    if (channel.at("channel") == name) {
      return stored_channel_from_json(channel);
    }
  }
  return fail(no_channel(newest->recording.id, name));
}

Result<Response> get_implied_by_model(ApiContext& context, const Request& request) {
  auto model = context.store.model(request.parameters[0]);
  if (!model) {
    return fail(model.error());
  }
  const auto recording = request.parameter("recording");
  const auto channel = request.parameter("channel");
  if (!recording || !channel) {
    const char* const missing = recording ? "channel" : "recording";
    return fail(ErrorCode::InvalidArgument, std::string("The parameter ") + missing + " is needed.",
                {{"parameter", missing}});
  }
  const auto told = newest_channel(context, std::string(*recording), std::string(*channel));
  if (!told) {
    return fail(told.error());
  }
  Faults faults;
  const auto simulated = simulation_model_from_json(stored(model->document_json), "", faults);
  if (!faults.none()) {
    return fail(faults.error());
  }
  const auto implied = implied_by(simulated, *told);
  if (!implied) {
    return fail(implied.error());
  }
  const Unit unit = told->told.parsed_unit();
  return json_response(200, Json{{"model", model->id},
                                 {"recording", *recording},
                                 {"channel", *channel},
                                 {"processes", driftlab::to_json(implied->processes, unit.dimension)},
                                 {"left_out", implied->left_out},
                                 {"implied", driftlab::to_json(implied->beside, unit.symbol)}});
}

}  // namespace

void add_characterisation_routes(Router& router, ApiContext& context) {
  router.add(from_rows({"GET",
                        "/v1/recordings/{id}/characterisation",
                        "getCharacterisation",
                        {"channel"},
                        Handler([&](const Request& request) { return get_characterisation(context, request); })}));
  router.add({"GET", "/v1/fits/{id}/implied", "getImpliedCurves", {}, Handler([&](const Request& request) {
                return get_implied(context, request);
              })});
  router.add({"GET",
              "/v1/models/{id}/implied",
              "getModelImpliedCurves",
              {"recording", "channel"},
              Handler([&](const Request& request) { return get_implied_by_model(context, request); })});
}

}  // namespace driftlab::server
