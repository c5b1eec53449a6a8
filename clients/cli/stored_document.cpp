#include "clients/cli/stored_document.hpp"

#include "clients/cli/print_answer.hpp"
#include "schema/json/characterisation.hpp"
#include "schema/json/stored_member.hpp"

#include <optional>
#include <set>

namespace driftlab::cli {
namespace {

/// What it says of one recording; a job may have characterised several.
Json of_recording(Json document, const std::string& id) {
  Json kept = Json::array();
  for (Json& recording : document["recordings"]) {
    if (text_member(recording, "id") == id) {
      kept.push_back(std::move(recording));
    }
  }
  return Json{{"recordings", std::move(kept)}};
}

/// Calls the recordings of a characterisation by their names, and says whose they are where all are of one device.
tl::expected<std::string, Failure> name_recordings(const std::string& server, Json& document) {
  std::set<std::string> devices;
  for (Json& recording : document["recordings"]) {
    const auto stored = fetch_document(server, "/v1/recordings/" + text_member(recording, "id"));
    if (!stored) {
      return tl::unexpected(stored.error());
    }
    devices.insert(text_member(*stored, "device"));
    if (const std::string name = text_member(stored->at("file"), "name"); !name.empty()) {
      recording["id"] = name;
    }
  }
  if (devices.size() != 1) {
    return std::string();
  }
  return fetch_document(server, "/v1/devices/" + *devices.begin()).map([](const Json& device) {
    return text_member(device, "name");
  });
}

tl::expected<StoredDocument, Failure> with_names(const std::string& server, Json document) {
  StoredDocument stored{"", std::move(document)};
  if (is_characterisation(stored.document)) {
    auto device = name_recordings(server, stored.document);
    if (!device) {
      return tl::unexpected(device.error());
    }
    stored.device = std::move(*device);
  }
  return stored;
}

}  // namespace

tl::expected<StoredDocument, Failure> fetch_result(const std::string& server, const std::string& id) {
  std::string target = "/v1/jobs/" + percent_encode(id) + "/result";
  if (id.starts_with("inv_")) {
    target = "/v1/investigations/" + percent_encode(id);
  } else if (id.starts_with("rec_")) {
    const auto newest = fetch_document(server, "/v1/recordings/" + percent_encode(id) + "/characterisation");
    if (!newest) {
      return tl::unexpected(newest.error());
    }
    target = "/v1/jobs/" + text_member(*newest, "job") + "/result";
  } else if (!id.starts_with("job_")) {
    return tl::unexpected(
        Failure{{ErrorCode::InvalidArgument,
                 "With --server name what the daemon has stored by its id (rec_…, inv_… or job_…), or a device "
                 "(--device NAME) and nothing else; '" +
                     id + "' is no such id.",
                 {}},
                Exit::BadInput});
  }
  auto document = fetch_document(server, target);
  if (!document) {
    return tl::unexpected(document.error());
  }
  return with_names(server, id.starts_with("rec_") ? of_recording(std::move(*document), id) : std::move(*document));
}

tl::expected<StoredDocument, Failure> fetch_tables(const std::string& server, const std::string& device) {
  Json tables = Json::array();
  std::optional<Failure> refusal;  // the first
  for (const char* const sensor : {"gyroscope", "accelerometer"}) {
    for (const char* const method : {"gmwm", "av"}) {
      const auto answer = fetch_document(server, "/v1/parameter-tables?device=" + percent_encode(device) +
                                                     "&sensor=" + sensor + "&axis=all&method=" + method);
      if (!answer && answer.error().exit != Exit::BadInput) {
        return tl::unexpected(answer.error());
      }
      if (!answer) {
        refusal = refusal.value_or(answer.error());
        continue;
      }
      for (const Json& table : answer->at("tables")) {
        tables.push_back(table);
      }
    }
  }
  if (tables.empty()) {
    const std::string none = "The daemon has no parameter table of the device \"" + device + "\".";
    return tl::unexpected(refusal.value_or(Failure{{ErrorCode::NotFound, none, {}}, Exit::BadInput}));
  }
  return StoredDocument{device, Json{{"device", device}, {"tables", std::move(tables)}}};
}

tl::expected<StoredDocument, Failure> fetch_device(const std::string& server, const std::string& device) {
  auto stored = fetch_tables(server, device);
  if (!stored) {
    return stored;
  }
  const auto summary = fetch_document(server, "/v1/devices/" + percent_encode(device) + "/summary");
  if (!summary) {
    return tl::unexpected(summary.error());
  }
  std::set<std::string> newest;
  for (const Json& channel : summary->at("channels")) {
    newest.insert(text_member(channel, "recording"));
  }
  Json recordings = Json::array();
  for (const std::string& id : newest) {
    auto one = fetch_result(server, id);
    if (!one) {
      return one;
    }
    for (Json& recording : one->document["recordings"]) {
      recordings.push_back(std::move(recording));
    }
  }
  stored->document["recordings"] = std::move(recordings);
  return stored;
}

}  // namespace driftlab::cli
