// GET /v1/events: everything that a page may want to show at once, in one stream for each tab.
#include "schema/json/stored_channel.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"

#include <algorithm>
#include <array>

namespace driftlab::server {
namespace {

constexpr std::array<std::string_view, 4> kTopics{"jobs", "recordings", "devices", "results"};
constexpr std::size_t kMostAtOnce = 200;

/// Where the result of a finished job is read.
std::string address_of(ApiContext& context, const Job& job) {
  InvestigationFilter filter;
  filter.job_id = job.id;
  const auto found = context.store.investigations(filter, Page{"", 1});
  return result_address(job.kind, job.id, found && !found->empty() ? found->front().id : "");
}

/// The sentence of a result: its own, or of a characterisation that of the channel that a person should look at first.
Json sentence_of(const Json& document) {
  if (const auto own = document.find("summary"); own != document.end() && own->is_object()) {
    return own->value("verdict", Json(nullptr));
  }
  std::vector<StoredChannel> channels;
  for (const Json& recording : document.value("recordings", Json::array())) {
    std::ranges::move(stored_channels_from_json(recording.value("channels", Json::array())),
                      std::back_inserter(channels));
  }
  const auto gravest = gravest_channel(channels);
  return gravest ? Json(gravest->verdict.sentence) : Json(nullptr);
}

void announce_result(ApiContext& context, const Job& job) {
  const auto text = context.store.result_document(job.id);
  const Json document = text ? stored(*text) : Json(nullptr);
  context.events.add("results", "result.created",
                     Json{{"job", job.id},
                          {"kind", job.kind},
                          {"href", address_of(context, job)},
                          {"verdict", document.is_object() ? sentence_of(document) : Json(nullptr)}});
}

class AllEvents final : public EventSource {
 public:
  AllEvents(ApiContext& context, std::vector<std::string> topics, const std::optional<std::string>& last_id)
      : store_(context.store), log_(context.events), topics_(std::move(topics)), after_(log_.latest()) {
    const auto number = last_id ? log_.number_of(*last_id) : std::nullopt;
    reset_ = last_id.has_value() && !number;
    after_ = number.value_or(after_);
  }

  [[nodiscard]] const std::string& subject() const override { return subject_; }

  [[nodiscard]] Result<Batch> next() override {
    const EventLog::Since since = log_.since(after_, kMostAtOnce);
    Batch batch;
    if (reset_ || !since.complete) {
      after_ = log_.latest();
      batch.text = "id: " + log_.id_of(after_) + "\nevent: reset\ndata: {}\n\n";
      reset_ = false;
      begun_ = true;
      return batch;
    }
    if (!begun_) {
      // The place from which a connection that breaks before the first event goes on.
      batch.text = "id: " + log_.id_of(after_) + "\nevent: ready\ndata: {}\n\n";
      begun_ = true;
    }
    for (const LoggedEvent& event : since.events) {
      after_ = event.number;
      if (std::find(topics_.begin(), topics_.end(), event.topic) != topics_.end() && is_visible(event)) {
        batch.text += "id: " + log_.id_of(event.number) + "\nevent: " + event.type + "\ndata: " + event.data + "\n\n";
      }
    }
    return batch;
  }

 private:
  /// What the listener could not read it does not hear of either. Of what is gone the store says nothing more, so that
  /// only a listener who is limited to devices is asked what it sees.
  bool is_visible(const LoggedEvent& event) {
    if (devices_of_caller() == nullptr) {
      return true;
    }
    const Json data = stored(event.data);
    if (event.type == "device.deleted") {
      return require_device(data.value("name", "")).has_value();
    }
    const auto names = [&data](const char* member) { return data.contains(member) && data[member].is_string(); };
    return (!names("device") || store_.device(data["device"].get<std::string>())) &&
           (!names("job") || store_.job(data["job"].get<std::string>()));
  }

  Store& store_;
  EventLog& log_;
  const std::string subject_{EventLog::kSubject};
  std::vector<std::string> topics_;
  std::int64_t after_;
  bool reset_ = false;
  bool begun_ = false;
};

Result<std::unique_ptr<EventSource>> all_events(ApiContext& context, const Request& request) {
  std::vector<std::string> topics;
  std::string_view rest = request.parameter("topics").value_or("jobs,recordings,devices,results");
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::string_view topic = rest.substr(0, comma);
    if (std::find(kTopics.begin(), kTopics.end(), topic) == kTopics.end()) {
      return fail(ErrorCode::InvalidArgument,
                  "The topics are jobs, recordings, devices and results, not '" + std::string(topic) + "'.",
                  {{"parameter", "topics"}});
    }
    topics.emplace_back(topic);
    if (comma == std::string_view::npos) {
      break;
    }
    rest.remove_prefix(comma + 1);
  }
  const auto last = request.header("last-event-id");
  return std::make_unique<AllEvents>(context, std::move(topics),
                                     last ? std::optional<std::string>(*last) : std::nullopt);
}

}  // namespace

void announce_job(ApiContext& context, const std::string& job_id) {
  const auto job = context.store.job(job_id);
  if (!job) {
    return;
  }
  context.events.add("jobs", "job",
                     Json{{"job", job->id},
                          {"kind", job->kind},
                          {"state", name_of(job->state)},
                          {"stage", job->stage.empty() ? Json(nullptr) : Json(job->stage)},
                          {"progress", number(job->progress)},
                          {"attempt", job->attempt},
                          {"at", rfc3339(context.clock.now())}});
  if (job->state == JobState::Succeeded && job->kind != "pool") {
    announce_result(context, *job);
  }
}

void add_event_routes(Router& router, ApiContext& context) {
  router.add({"GET", "/v1/events", "streamEvents", {"topics"}, EventHandler([&](const Request& request) {
                return all_events(context, request);
              })});
}

}  // namespace driftlab::server
