// Recordings that are still being made: a phone or a board sends its samples second by second, and what they say so far
// is followed live. What was acknowledged is on the disk; finished, it is a recording like any other.
#include "server/store/live_recordings.hpp"

#include "core/signal/number.hpp"
#include "schema/json/growing_recording.hpp"
#include "schema/json/recording_spec.hpp"
#include "server/api/device_name.hpp"
#include "server/api/documents.hpp"
#include "server/api/record_blob.hpp"
#include "server/api/upload.hpp"
#include "server/auth/secret.hpp"
#include "server/http/problem.hpp"
#include "server/store/digest.hpp"
#include "server/store/guarded_round.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <limits>
#include <optional>
#include <thread>

namespace driftlab::server {
namespace {

constexpr UtcMicros kTokenMicros = 24LL * 3600 * 1'000'000;
constexpr UtcMicros kUnfinishedMicros = 3600LL * 1'000'000;
constexpr std::size_t kMostColumns = 32;
constexpr std::size_t kLongestPiece = 1024UL * 1024;
constexpr std::string_view kTime = "time";

/// What `about_json` of a live recording holds.
struct About {
  UploadMetadata metadata;
  std::vector<std::string> columns;  ///< in the order of the values
};

/// What was within the budgets when it began is so to its end.
const Budgets& budgets_of_what_began() {
  static const Budgets boundless = [] {
    Budgets budgets;
    for (std::int64_t* const limit : {&budgets.labels, &budgets.label_bytes, &budgets.name_bytes}) {
      *limit = std::numeric_limits<std::int64_t>::max();
    }
    return budgets;
  }();
  return boundless;
}

Result<About> about_of(const LiveRecording& recording) {
  const Json document = stored(recording.about_json);
  Request began;
  began.budgets = &budgets_of_what_began();
  auto metadata = metadata_from_json(to_text(document.at("metadata")), began);
  if (!metadata) {
    return fail(metadata.error());
  }
  return About{std::move(*metadata), document.at("columns").get<std::vector<std::string>>()};
}

Unit unit_of(const About& about, const std::string& column) {
  return about.metadata.spec.columns.at(column).unit.value_or(Unit{});
}

Json to_json(const Principal& principal) {
  return Json{{"token", principal.token},
              {"name", principal.name},
              {"scope", name_of(principal.scope)},
              {"devices", principal.devices ? Json(*principal.devices) : Json(nullptr)}};
}

/// Who began it, for whom everything is done with it; nothing where an earlier release began it and did not say.
std::optional<Principal> principal_of(const LiveRecording& recording) {
  const Json about = stored(recording.about_json);
  if (!about.contains("principal")) {
    return std::nullopt;
  }
  const Json& kept = about.at("principal");
  Principal principal;
  principal.token = kept.at("token").get<std::string>();
  principal.name = kept.at("name").get<std::string>();
  principal.scope = parse_scope(kept.at("scope").get<std::string>()).value_or(Scope::Public);
  if (!kept.at("devices").is_null()) {
    principal.devices = kept.at("devices").get<std::vector<std::string>>();
  }
  return principal;
}

/// Names of the columns as the body has them, in its order; all of them sensors or a temperature with their unit.
std::vector<std::string> column_names(const Json& body, Faults& faults) {
  std::vector<std::string> names;
  if (!body.is_object() || !body.contains("columns") || !body["columns"].is_object() || body["columns"].empty() ||
      body["columns"].size() > kMostColumns) {
    faults.add("/columns", ErrorCode::InvalidArgument, "Name 1 to 32 columns with their quantity, axis and unit.");
    return names;
  }
  for (const auto& [name, role] : body["columns"].items()) {
    const bool plain = name.find_first_of(",\"\n\r") == std::string::npos && name != kTime;
    if (!plain || !role.is_object() || !role.contains("unit")) {
      faults.add("/columns", ErrorCode::InvalidArgument,
                 "The column '" + name + "' needs a unit, and a name other than time without comma and quote.");
    }
    names.push_back(name);
  }
  return names;
}

class Live {
 public:
  explicit Live(ApiContext& context)
      : context_(context), recordings_(context.data / "live", context.clock), sweeper_([this] { sweep(); }) {}
  Live(const Live&) = delete;
  Live& operator=(const Live&) = delete;
  ~Live() {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    stopped_.notify_all();
    sweeper_.join();
  }

  LiveRecordings& recordings() { return recordings_; }
  ApiContext& context() { return context_; }
  /// Held while one is begun, so that those that begin at once do not pass the budgets together.
  std::mutex& beginning() { return begin_; }

  /// Whether the token that began it is valid still.
  [[nodiscard]] bool is_admitted(const LiveRecording& recording) const {
    const auto principal = principal_of(recording);
    return !principal || context_.gate.is_valid(*principal);
  }

  /// Makes a recording of what is there, for whoever began it, and queues its characterisation. `job` is null where it
  /// could not be queued, or where who began it may ask for none.
  Result<Json> finish(const std::string& id) {
    const std::lock_guard finishing(finish_);
    const auto live = recordings_.find(id);
    if (!live) {
      return fail(live.error());
    }
    Caller caller = caller_of_thread() != nullptr ? *caller_of_thread() : Caller{};
    std::optional<ActingFor> acting;
    if (auto principal = principal_of(*live)) {
      caller.principal = std::move(*principal);
      acting.emplace(caller);
    }
    auto about = about_of(*live);
    const auto samples = recordings_.samples(id);
    if (!about || !samples) {
      return fail(!about ? about.error() : samples.error());
    }
    auto blob = context_.blobs.begin();
    if (!blob) {
      return fail(blob.error());
    }
    if (Status written = write_csv(**blob, *about, *samples); !written) {
      return fail(written.error());
    }
    about->metadata.spec.columns[std::string(kTime)] = {Quantity::Time, "", parse_unit("s").value()};
    about->metadata.spec.rate_hz.reset();  // the stamps say it
    auto made = record_blob(context_, **blob, about->metadata);
    if (!made) {
      return fail(made.error());
    }
    Json recording = stored(made->body);
    const Json job = characterise(recording.at("id").get<std::string>());
    (void)recordings_.remove(id);
    context_.bell.ring(id);
    return Json{{"recording", std::move(recording)}, {"job", job}};
  }

 private:
  static Status write_csv(IncomingBlob& blob, const About& about, const LiveSamples& samples) {
    std::string text(kTime);
    for (const std::string& column : about.columns) {
      text += ',' + column;
    }
    text += '\n';
    for (std::size_t row = 0; row < samples.time_s.size(); ++row) {
      text += driftlab::to_text(samples.time_s[row] - samples.time_s.front());
      for (const std::vector<double>& column : samples.columns) {
        text += ',';
        if (std::isfinite(column[row])) {
          std::array<char, 32> buffer{};
          const auto [stop, error] =
              std::to_chars(buffer.data(), buffer.data() + buffer.size(), static_cast<float>(column[row]));
          text.append(buffer.data(), error == std::errc{} ? stop : buffer.data());
        }
      }
      text += '\n';
      if (text.size() > kLongestPiece || row + 1 == samples.time_s.size()) {
        if (Status added = blob.append(std::as_bytes(std::span(text))); !added) {
          return added;
        }
        text.clear();
      }
    }
    if (samples.time_s.empty()) {
      return fail(ErrorCode::NoSamples, "No samples came; there is nothing to record.");
    }
    return blob.seal();
  }

  Json characterise(const std::string& recording) {
    const Caller* const caller = caller_of_thread();
    const bool may = caller == nullptr || caller->principal.scope >= Scope::Run;
    if (!may || refuse_full_queue(context_.store, context_.budgets)) {
      return nullptr;
    }
    JobContext job_context = context_.job_context();
    const auto job = new_job(*find_job_kind("characterise"), Json{{"recordings", Json::array({recording})}},
                             Json::object(), job_context);
    const auto queued = job ? context_.store.enqueue(*job) : Result<EnqueuedJob>(fail(job.error()));
    if (!queued) {
      return nullptr;
    }
    announce_job(context_, queued->job.id);
    context_.wake_workers();
    return to_json(queued->job);
  }

  /// What nobody has added to for an hour is finished as it is, at the latest six hours after a try that failed; what
  /// cannot be a recording, or whose token was revoked, is dropped after a day.
  void sweep() {
    std::unique_lock lock(mutex_);
    while (!stopped_.wait_for(lock, std::chrono::minutes(1), [this] { return stopping_; })) {
      lock.unlock();
      (void)guarded_round("live recordings", [this] {
        const UtcMicros now = context_.clock.now();
        for_each(recordings_.due_since(now - kUnfinishedMicros), [this](const std::string& id) { try_to_finish(id); });
        for_each(recordings_.untouched_since(now - kTokenMicros),
                 [this](const std::string& id) { (void)recordings_.remove(id); });
      });
      lock.lock();
    }
  }

  void try_to_finish(const std::string& id) {
    recordings_.put_off(id);  // an exception is a failure too
    if (const auto live = recordings_.find(id); live && is_admitted(*live)) {
      (void)finish(id);
    }
  }

  /// An exception over one recording leaves the others their turn.
  static void for_each(const std::vector<std::string>& ids, const std::function<void(const std::string& id)>& treat) {
    for (const std::string& id : ids) {
      (void)guarded_round("live recordings", [&] { treat(id); });
    }
  }

  ApiContext& context_;
  LiveRecordings recordings_;
  std::mutex begin_;
  std::mutex finish_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stopping_ = false;
  std::thread sweeper_;
};

/// The recording that the path names, for whoever may know of its device.
Result<LiveRecording> seen(Live& live, const Request& request) {
  const std::string& id = request.parameters[0];
  auto recording = live.recordings().find(id);
  if (recording && !require_device(stored(recording->about_json).at("device").get<std::string>())) {
    return fail(ErrorCode::NotFound, "There is no live recording \"" + id + "\"; it may have been finished.",
                {{"live_recording", id}});
  }
  return recording;
}

/// The recording that the path names, for whoever has its token.
Result<LiveRecording> admitted(Live& live, const Request& request) {
  auto recording = live.recordings().find(request.parameters[0]);
  if (!recording) {
    return recording;
  }
  const auto token = request.header("live-token");
  const UtcMicros made = stored(recording->about_json).at("created_at").get<UtcMicros>();
  const bool fresh = live.context().clock.now() < made + kTokenMicros;
  if (!token || !is_same_digest(sha256_hex(*token), recording->token_sha256) || !fresh) {
    return fail(ErrorCode::NotFound,
                fresh ? "Send the token of this live recording in the header Live-Token."
                      : "The token of this live recording is older than a day.",
                {{"parameter", "Live-Token"}});
  }
  return recording;
}

/// The answer where the token that began it was revoked or has expired: that of the recording is worth no more.
std::optional<Response> refuse_ended(const Live& live, const LiveRecording& recording) {
  if (live.is_admitted(recording)) {
    return std::nullopt;
  }
  Response response = problem_response(HttpFault::Unauthorized,
                                       "The token that began this live recording was revoked, or has expired.");
  response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"driftlab\", error=\"invalid_token\"");
  return response;
}

/// The answer where no further live recording may begin.
std::optional<Response> refuse_more(Live& live, const std::string& owner) {
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

Result<Response> create(Live& live, const Request& request) {
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
  const Json about{{"metadata", *body},
                   {"device", metadata->device.name},
                   {"columns", columns},
                   {"created_at", now},
                   {"principal", to_json(principal)}};
  const std::lock_guard beginning(live.beginning());
  if (auto refusal = refuse_more(live, principal.token)) {
    return std::move(*refusal);
  }
  const auto made = live.recordings().create(to_text(about), sha256_hex(token), columns.size(), principal.token);
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

Result<Response> get(Live& live, const Request& request) {
  const auto recording = seen(live, request);
  return recording ? Result<Response>(json_response(200, to_json(*recording))) : fail(recording.error());
}

Result<Response> finish(Live& live, const Request& request) {
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
  SamplesUpload(Live& live, std::string id, std::uint32_t number) : live_(live), id_(std::move(id)), number_(number) {}

  [[nodiscard]] Status append(std::span<const std::byte> bytes) override {
    if (bytes_.size() + bytes.size() > kLongestPiece) {
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
  Live& live_;
  std::string id_;
  std::uint32_t number_;
  std::vector<std::byte> bytes_;
};

Result<std::unique_ptr<UploadSession>> begin_samples(Live& live, const Request& request) {
  const auto recording = admitted(live, request);
  if (!recording) {
    return fail(recording.error());
  }
  if (auto ended = refuse_ended(live, *recording)) {
    return std::make_unique<RefusedUpload>(std::move(*ended), kLongestPiece);
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

/// What the samples say so far, every two seconds at most, and less often where that takes long.
class LiveEvents final : public EventSource {
 public:
  LiveEvents(Live& live, std::string id, About about, std::string channel)
      : live_(live), id_(std::move(id)), about_(std::move(about)), channel_(std::move(channel)) {}

  [[nodiscard]] const std::string& subject() const override { return id_; }

  [[nodiscard]] Result<Batch> next() override {
    const auto now = std::chrono::steady_clock::now();
    const auto recording = live_.recordings().find(id_);
    if (!recording) {
      return Batch{"event: finished\ndata: {}\n\n", true};
    }
    if (now < due_ || recording->samples == told_) {
      return Batch{};
    }
    const auto samples = live_.recordings().samples(id_);
    if (!samples) {
      return Batch{};
    }
    const auto column = static_cast<std::size_t>(std::find(about_.columns.begin(), about_.columns.end(), channel_) -
                                                 about_.columns.begin());
    const GrowingRecording look = look_at_growth(samples->time_s, samples->columns[column]);
    Json data = growing_recording_to_json(look, unit_of(about_, channel_));
    data["channel"] = channel_;
    data["still"] = still(*samples);
    told_ = recording->samples;
    const auto took = std::chrono::steady_clock::now() - now;
    due_ = now + std::max<std::chrono::steady_clock::duration>(std::chrono::seconds(2), 20 * took);
    return Batch{"id: " + std::to_string(told_) + "\nevent: growth\ndata: " + to_text(data) + "\n\n", false};
  }

 private:
  /// False as soon as one sensor moves; null where none can tell.
  [[nodiscard]] Json still(const LiveSamples& samples) const {
    Json answer = nullptr;
    for (std::size_t c = 0; c < about_.columns.size(); ++c) {
      const auto rests = lies_still(samples.time_s, samples.columns[c], unit_of(about_, about_.columns[c]));
      if (rests && (answer.is_null() || !*rests)) {
        answer = *rests;
      }
    }
    return answer;
  }

  Live& live_;
  std::string id_;
  About about_;
  std::string channel_;
  std::size_t told_ = 0;
  std::chrono::steady_clock::time_point due_{};
};

Result<std::unique_ptr<EventSource>> events(Live& live, const Request& request) {
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
  return std::make_unique<LiveEvents>(live, recording->id, std::move(*about), std::move(channel));
}

}  // namespace

void add_live_recording_routes(Router& router, ApiContext& context) {
  const auto live = std::make_shared<Live>(context);
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
