#include "clients/cli/analysis.hpp"
#include "clients/cli/progress.hpp"
#include "clients/cli/remote_upload.hpp"
#include "schema/json/campaign_summary.hpp"
#include "schema/json/characterise.hpp"

#include <algorithm>
#include <map>

namespace driftlab::cli {
namespace {

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
    auto id = upload_file(client, inputs.device, file, {}, [&](double fraction) {
      bar.show("upload " + file.spec.id, kUploads * (done + fraction) / static_cast<double>(inputs.files.size()));
    });
    if (!id) {
      return tl::unexpected(id.error());
    }
    ids.push_back(std::move(*id));
  }
  return ids;
}

/// Returns when what the daemon has of these sensors is pooled, so that a table asked for next is final.
tl::expected<void, Failure> await_pooling(HttpClient& client, const std::string& device, const Json& document) {
  const auto sensors = sensors_of(document);
  if (!sensors) {
    return tl::unexpected(Failure{sensors.error(), Exit::ServerOrJob});
  }
  for (const SensorSources& sensor : *sensors) {
    const auto quantity = parse_quantity(sensor.quantity);
    if (!quantity || !is_axis_of(sensor.axis, *quantity)) {
      continue;  // channels that nobody named by axis are not pooled
    }
    auto table = client.get_settled("/v1/parameter-tables?device=" + percent_encode(device) + "&sensor=" +
                                        percent_encode(sensor_of(*quantity)) + "&axis=" + percent_encode(sensor.axis),
                                    "application/json", [] { return interrupt_token().stop_requested(); });
    if (!table) {
      return unreachable(table.error());
    }
  }
  return {};
}

/// Names of `ids` as the inputs have them.
void rename_all(Json& ids, const std::map<std::string, std::string>& names) {
  for (Json& id : ids) {
    const auto found = id.is_string() ? names.find(id.get<std::string>()) : names.end();
    if (found != names.end()) {
      id = found->second;
    }
  }
}

}  // namespace

Json named_as_here(Json document, const Inputs& inputs) {
  std::map<std::string, std::string> names;
  Json& recordings = document["recordings"];
  for (std::size_t i = 0; i < recordings.size() && i < inputs.files.size(); ++i) {
    names[recordings[i].value("id", "")] = inputs.files[i].spec.id;
    recordings[i]["id"] = inputs.files[i].spec.id;
  }
  Json pooled = document.value("replicates", Json::array());
  for (Json& sensor : pooled) {
    for (Json& condition : sensor["conditions"]) {
      // The daemon's members are results, of the recordings in the same order; here they are the recordings.
      if (condition["members"].size() == condition["recordings"].size()) {
        condition["members"] = condition["recordings"];
      }
      rename_all(condition["recordings"], names);
      rename_all(condition["members"], names);
      std::sort(condition["members"].begin(), condition["members"].end());
    }
  }
  document["replicates"] = std::move(pooled);
  return document;
}

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
  auto document = run_job(*client, request, bar, kUploads);
  if (document) {
    bar.show("pool", 1.0);
    if (auto waited = await_pooling(*client, inputs.device, *document); !waited) {
      return tl::unexpected(waited.error());
    }
  }
  return document;
}

}  // namespace driftlab::cli
