// Recordings that are still being made: a phone or a board sends its samples second by second, and what they say so far
// is followed live. What was acknowledged is on the disk; finished, it is a recording like any other.
#include "server/api/device_name.hpp"
#include "server/api/documents.hpp"
#include "server/api/live_events.hpp"
#include "server/api/live_keeper.hpp"
#include "server/api/record_blob.hpp"
#include "server/api/upload.hpp"
#include "server/auth/secret.hpp"
#include "server/http/problem.hpp"
#include "server/store/digest.hpp"

#include <algorithm>
#include <charconv>
#include <mutex>
#include <optional>

namespace driftlab::server {
namespace {

constexpr std::size_t kMostColumns = 32;

/// Names of the columns as the body has them, in its order; all of them sensors or a temperature with their unit.
std::vector<std::string> column_names(const Json& body, Faults& faults) {
  std::vector<std::string> names;
  if (!body.is_object() || !body.contains("columns") || !body["columns"].is_object() || body["columns"].empty() ||
      body["columns"].size() > kMostColumns) {
    faults.add("/columns", ErrorCode::InvalidArgument, "Name 1 to 32 columns with their quantity, axis and unit.");
    return names;
  }
  for (const auto& [name, role] : body["columns"].items()) {
    const bool plain = name.find_first_of(",\"\n\r") == std::string::npos && name != kLiveTime;
    if (!plain || !role.is_object() || !role.contains("unit")) {
      faults.add("/columns", ErrorCode::InvalidArgument,
                 "The column '" + name + "' needs a unit, and a name other than time without comma and quote.");
    }
    names.push_back(name);
  }
  return names;
}

/// The recording that the path names, for whoever may know of its device.
Result<LiveRecording> seen(LiveKeeper& live, const Request& request) {
  const std::string& id = request.parameters[0];
  auto recording = live.recordings().find(id);
  if (recording && !require_device(stored(recording->about_json).at("device").get<std::string>())) {
    return fail(ErrorCode::NotFound, "There is no live recording \"" + id + "\"; it may have been finished.",
                {{"live_recording", id}});
  }
  return recording;
}

/// The recording that the path names, for whoever has its token.
Result<LiveRecording> admitted(LiveKeeper& live, const Request& request) {
  auto recording = live.recordings().find(request.parameters[0]);
  if (!recording) {
    return recording;
  }
  const auto token = request.header("live-token");
  const UtcMicros made = stored(recording->about_json).at("created_at").get<UtcMicros>();
  const bool fresh = live.context().clock.now() < made + kLiveMicros;
  if (!token || !is_same_digest(sha256_hex(*token), recording->token_sha256) || !fresh) {
    return fail(ErrorCode::NotFound,
                fresh ? "Send the token of this live recording in the header Live-Token."
                      : "The token of this live recording is older than a day.",
                {{"parameter", "Live-Token"}});
  }
  return recording;
}

/// The answer where the token that began it was revoked or has expired: that of the recording is worth no more.
std::optional<Response> refuse_ended(const LiveKeeper& live, const LiveRecording& recording) {
  if (live.is_admitted(recording)) {
    return std::nullopt;
  }
  Response response = problem_response(HttpFault::Unauthorized,
                                       "The token that began this live recording was revoked, or has expired.");
  response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"driftlab\", error=\"invalid_token\"");
  return response;
}

/// The answer where no further live recording may begin.
std::optional<Response> refuse_more(LiveKeeper& live, const std::string& owner) {
  const Budgets& budgets = live.context().budgets;
  const auto open = live.recordings().open_of(owner);
  if (!owner.empty() && open.of_owner >= budgets.live_recordings_per_token) {
    return problem_response(HttpFault::TooManyRequests,
                            "The token has as many live recordings as it may have " +
                                naming_budget("live_recordings_per_token", budgets.live_recordings_per_token) +
                                "; finish one.");
  }
  if (open.all >= budgets.live_recordings) {
    return problem_response(HttpFault::Busy, "Too many live recordings are not finished " +
                                                 naming_budget("live_recordings", budgets.live_recordings) + ".");
  }
  return std::nullopt;
}

Json to_json(const LiveRecording& recording) {
  const Json about = stored(recording.about_json);
  return Json{{"id", recording.id},
              {"device", about.at("device")},
              {"condition", about.at("metadata").at("condition")},
              {"columns", about.at("columns")},
              {"samples", recording.samples},
              {"pieces", recording.pieces},
              {"touched_at", rfc3339(recording.touched_at)}};
}

Result<Response> create(LiveKeeper& live, const Request& request) {
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  const std::vector<std::string> columns = column_names(*body, faults);
  if (!faults.none()) {
    return fail(faults.error());
  }
  auto metadata = metadata_from_json(request.body, request);
  if (!metadata) {
    return fail(metadata.error());
  }
  if (auto resolved = resolve_device_name(live.context().store, metadata->device); !resolved) {
    return fail(resolved.error());
  }
  const UtcMicros now = live.context().clock.now();
  const std::string token = "lt_" + make_random_secret();
  if (body->at("device").is_string()) {
    (*body)["device"] = metadata->device.name;  // an id was resolved
  }
  const Principal& principal = request.caller.principal;
  const std::string about = live_about_text(*body, metadata->device.name, columns, now, principal);
  const std::lock_guard beginning(live.beginning());
  if (auto refusal = refuse_more(live, principal.token)) {
    return std::move(*refusal);
  }
  const auto made = live.recordings().create(about, sha256_hex(token), columns.size(), principal.token);
  if (!made) {
    return fail(made.error());
  }
  Json document = to_json(*made);
  document["token"] = token;
  document["href"] = "/record?live=" + made->id + "#" + token;
  Response response = json_response(201, document);
  response.headers.emplace_back("Location", "/v1/live-recordings/" + made->id);
  response.headers.emplace_back("Cache-Control", "no-store");
  return response;
}

Result<Response> get(LiveKeeper& live, const Request& request) {
  const auto recording = seen(live, request);
  return recording ? Result<Response>(json_response(200, to_json(*recording))) : fail(recording.error());
}

Result<Response> finish(LiveKeeper& live, const Request& request) {
  const auto recording = admitted(live, request);
  if (!recording) {
    return fail(recording.error());
  }
  if (auto ended = refuse_ended(live, *recording)) {
    return std::move(*ended);
  }
  auto made = live.finish(request.parameters[0]);
  if (!made) {
    return fail(made.error());
  }
  Response response = json_response(201, *made);
  response.headers.emplace_back("Location", "/v1/recordings/" + made->at("recording").at("id").get<std::string>());
  return response;
}

class SamplesUpload final : public UploadSession {
 public:
  SamplesUpload(LiveKeeper& live, std::string id, std::uint32_t number)
      : live_(live), id_(std::move(id)), number_(number) {}

  [[nodiscard]] Status append(std::span<const std::byte> bytes) override {
    if (bytes_.size() + bytes.size() > kLongestLivePiece) {
      return fail(ErrorCode::LimitExceeded, "A piece of a live recording has 1 MiB at most.");
    }
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return {};
  }

  [[nodiscard]] Result<Response> finish() override {
    const auto recording = live_.recordings().find(id_);
    if (auto ended = recording ? refuse_ended(live_, *recording) : std::nullopt) {
      return std::move(*ended);
    }
    const auto added = live_.recordings().add(id_, number_, bytes_);
    if (!added) {
      return fail(added.error());
    }
    live_.context().bell.ring(id_);
    Response response;
    response.status = 204;
    return response;
  }

 private:
  LiveKeeper& live_;
  std::string id_;
  std::uint32_t number_;
  std::vector<std::byte> bytes_;
};

Result<std::unique_ptr<UploadSession>> begin_samples(LiveKeeper& live, const Request& request) {
  const auto recording = admitted(live, request);
  if (!recording) {
    return fail(recording.error());
  }
  if (auto ended = refuse_ended(live, *recording)) {
    return std::make_unique<RefusedUpload>(std::move(*ended), kLongestLivePiece);
  }
  if (auto room = require_space(live.context()); !room) {
    return fail(room.error());
  }
  const std::string_view text = request.parameter("sequence").value_or("");
  std::uint32_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc{} || stop != text.data() + text.size()) {
    return fail(ErrorCode::InvalidArgument, "Number the pieces from 0: ?sequence=…", {{"parameter", "sequence"}});
  }
  return std::make_unique<SamplesUpload>(live, recording->id, number);
}

Result<std::unique_ptr<EventSource>> events(LiveKeeper& live, const Request& request) {
  const auto recording = seen(live, request);
  if (!recording) {
    return fail(recording.error());
  }
  auto about = about_of(*recording);
  if (!about) {
    return fail(about.error());
  }
  std::string channel(request.parameter("channel").value_or(about->columns.front()));
  if (std::find(about->columns.begin(), about->columns.end(), channel) == about->columns.end()) {
    return fail(ErrorCode::UnknownColumn, "The live recording has no column '" + channel + "'.",
                {{"parameter", "channel"}});
  }
  return growth_events(live.recordings(), recording->id, std::move(*about), std::move(channel));
}

}  // namespace

void add_live_recording_routes(Router& router, ApiContext& context) {
  const auto live = std::make_shared<LiveKeeper>(context);
  router.add({"POST", "/v1/live-recordings", "createLiveRecording", {}, Handler([live](const Request& request) {
                return create(*live, request);
              })});
  router.add({"GET", "/v1/live-recordings/{id}", "getLiveRecording", {}, Handler([live](const Request& request) {
                return get(*live, request);
              })});
  router.add({"POST",
              "/v1/live-recordings/{id}/samples",
              "addLiveSamples",
              {"sequence"},
              UploadHandler([live](const Request& request) { return begin_samples(*live, request); })});
  router.add(in_lane(
      Lane::Decoding,
      {"POST", "/v1/live-recordings/{id}/finish", "finishLiveRecording", {}, Handler([live](const Request& request) {
         return finish(*live, request);
       })}));
  router.add({"GET",
              "/v1/live-recordings/{id}/events",
              "streamLiveRecording",
              {"channel"},
              EventHandler([live](const Request& request) { return events(*live, request); })});
}

}  // namespace driftlab::server
