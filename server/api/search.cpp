// Finding by names, models, conditions and ids: what the find field of the pages asks.
#include "core/signal/condition.hpp"
#include "core/signal/text.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <vector>

namespace driftlab::server {
namespace {

constexpr int kMostDevices = 1000;      ///< looked at for names that begin so
constexpr std::size_t kLookedAt = 100;  ///< likewise of recordings, the first by name that hold the text
constexpr std::array<std::string_view, 5> kIds{"dev_", "rec_", "job_", "mod_", "inv_"};

Json hit(std::string_view kind, const std::string& id, const std::string& title, const std::string& subtitle,
         const std::string& href) {
  return Json{{"kind", kind}, {"id", id}, {"title", title}, {"subtitle", subtitle}, {"href", href}};
}

/// `rec_01m8` -> `rec_01M8`, what an id begins with; nothing where no id begins so.
std::optional<std::string> beginning_of_id(const std::string& text) {
  constexpr std::size_t kPrefix = 4;
  std::string id = lower_case(text);
  std::transform(id.begin() + static_cast<std::ptrdiff_t>(std::min(kPrefix, id.size())), id.end(),
                 id.begin() + static_cast<std::ptrdiff_t>(std::min(kPrefix, id.size())),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const bool known =
      std::any_of(kIds.begin(), kIds.end(), [&](std::string_view prefix) { return id.starts_with(prefix); });
  return known && id.size() > kPrefix ? std::optional(id) : std::nullopt;
}

Json hit(const Device& device) {
  return hit("device", device.id, device.name, device.model.empty() ? "device" : "device, " + device.model,
             "/v1/devices/" + device.id);
}

Json hit(Store& store, const Recording& recording) {
  const auto device = store.device(recording.device_id);
  const auto condition = parse_condition(recording.condition);
  return hit("recording", recording.id, recording.name.empty() ? recording.id : recording.name,
             "recording" + (device ? " of " + device->name : std::string()) + ", " +
                 (condition ? label(*condition) : recording.condition),
             "/v1/recordings/" + recording.id);
}

Json hit(const Job& job) {
  return hit("job", job.id, job.kind, "job, " + std::string(name_of(job.state)), "/v1/jobs/" + job.id);
}

Json hit(const Model& model) { return hit("model", model.id, model.name, "model", "/v1/models/" + model.id); }

Json hit(Store& store, const Investigation& investigation) {
  const auto device = store.device(investigation.device_id);
  return hit("investigation", investigation.id, device ? device->name : investigation.id,
             "investigation of " + rfc3339(investigation.created_at).substr(0, 10),
             "/v1/investigations/" + investigation.id);
}

/// The one object whose whole id was typed; null where there is none.
Json by_id(Store& store, const std::string& id) {
  if (const auto device = store.device(id); id.starts_with("dev_") && device) {
    return hit(*device);
  }
  if (const auto recording = store.recording(id); id.starts_with("rec_") && recording) {
    return hit(store, *recording);
  }
  if (const auto job = store.job(id); id.starts_with("job_") && job) {
    return hit(*job);
  }
  if (const auto model = store.model(id); id.starts_with("mod_") && model) {
    return hit(*model);
  }
  if (const auto found = store.investigation(id); id.starts_with("inv_") && found) {
    return hit(store, *found);
  }
  return nullptr;
}

/// The hits of each kind of object, those that begin with the text first.
class Hits {
 public:
  explicit Hits(std::string wanted) : wanted_(std::move(wanted)) {}
  void add(std::size_t kind, Json found, std::string_view name) {
    const std::string id = found.at("id").get<std::string>();
    if (std::find(seen_.begin(), seen_.end(), id) == seen_.end()) {
      seen_.push_back(id);
      (lower_case(name).starts_with(wanted_) ? first_ : later_)[kind].push_back(std::move(found));
    }
  }
  /// At most `limit`, and as many as fit into that many bytes, in the order of the kinds, each with its share where
  /// there are too many. One that is larger comes alone.
  [[nodiscard]] Json taken(std::size_t limit, std::size_t bytes) const {
    std::array<std::vector<Json>, kKinds> lists;
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
      lists[kind] = first_[kind];
      lists[kind].insert(lists[kind].end(), later_[kind].begin(), later_[kind].end());
    }
    std::array<std::size_t, kKinds> shares{};
    std::size_t size = 0;
    for (bool more = true; more && limit > 0;) {
      more = false;
      for (std::size_t kind = 0; kind < kKinds && limit > 0; ++kind) {
        if (shares[kind] < lists[kind].size()) {
          const std::size_t length = to_text(lists[kind][shares[kind]]).size() + 1;
          if (size > 0 && size + length > bytes) {
            limit = 0;
            break;
          }
          size += length;
          ++shares[kind];
          --limit;
          more = true;
        }
      }
    }
    Json items = Json::array();
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
      for (std::size_t i = 0; i < shares[kind]; ++i) {
        items.push_back(std::move(lists[kind][i]));
      }
    }
    return items;
  }

 private:
  static constexpr std::size_t kKinds = 5;  ///< device, recording, model, investigation, job
  std::string wanted_;
  std::vector<std::string> seen_;
  std::array<std::vector<Json>, kKinds> first_, later_;
};

/// Names, models, conditions and findings that hold the text.
Status add_named(Store& store, const std::string& text, std::size_t most, Hits& hits) {
  const auto found = store.devices(DeviceFilter{text}, Page{"", kMostDevices});
  if (!found) {
    return fail(found.error());
  }
  for (const Device& device : *found) {
    hits.add(0, hit(device), device.name);
  }
  // A condition is stored as constant_rate:z:9:deg/s and said as 9 deg/s.
  std::string compact = text;
  std::replace(compact.begin(), compact.end(), ' ', ':');
  std::size_t recordings = 0;
  for (const std::string& sought : {text, compact}) {
    RecordingFilter filter;
    filter.text = sought;
    const auto rows =
        store.recordings(filter, Page{"", static_cast<int>(std::max(most, kLookedAt)), PageOrder::ByName});
    if (!rows) {
      return fail(rows.error());
    }
    for (const Recording& recording : *rows) {
      hits.add(1, hit(store, recording), recording.name);
    }
    recordings += rows->size();
    if (compact == text || recordings >= most) {
      break;
    }
  }
  const Page newest{"", static_cast<int>(most), PageOrder::NewestFirst};
  ModelFilter model_filter;
  model_filter.text = text;
  const auto models = store.models(model_filter, newest);
  InvestigationFilter investigation_filter;
  investigation_filter.text = text;
  const auto investigations = store.investigations(investigation_filter, newest);
  if (!models || !investigations) {
    return fail(!models ? models.error() : investigations.error());
  }
  for (const Model& model : *models) {
    hits.add(2, hit(model), model.name);
  }
  for (const Investigation& investigation : *investigations) {
    hits.add(3, hit(store, investigation), "");
  }
  return {};
}

/// Jobs whose id begins so; the ids of everything else are among what add_named() seeks.
Status add_jobs(Store& store, const std::string& beginning, std::size_t most, Hits& hits) {
  const auto jobs = store.jobs({}, Page{beginning, static_cast<int>(most), PageOrder::OldestFirst});
  if (!jobs) {
    return fail(jobs.error());
  }
  for (const Job& job : *jobs) {
    if (job.id.starts_with(beginning)) {
      hits.add(4, hit(job), job.id);
    }
  }
  return {};
}

Result<Response> search(ApiContext& context, const Request& request) {
  const std::string text(request.parameter("q").value_or(""));
  if (text.empty() || text.size() > 200) {
    return fail(ErrorCode::InvalidArgument, "Say what to find in 1 to 200 bytes: ?q=…", {{"parameter", "q"}});
  }
  std::size_t limit = 10;
  if (const auto asked = request.parameter("limit")) {
    const auto [stop, error] = std::from_chars(asked->data(), asked->data() + asked->size(), limit);
    if (error != std::errc{} || stop != asked->data() + asked->size() || limit < 1 || limit > 50) {
      return fail(ErrorCode::InvalidArgument, "The limit is a whole number from 1 to 50.", {{"parameter", "limit"}});
    }
  }
  const auto beginning = beginning_of_id(text);
  if (Json exact = beginning ? by_id(context.store, *beginning) : Json(nullptr); !exact.is_null()) {
    return json_response(200, Json{{"items", Json::array({std::move(exact)})}});
  }
  Hits hits(lower_case(text));
  if (auto named = add_named(context.store, text, limit, hits); !named) {
    return fail(named.error());
  }
  if (beginning && beginning->starts_with("job_")) {
    if (auto jobs = add_jobs(context.store, *beginning, limit, hits); !jobs) {
      return fail(jobs.error());
    }
  }
  return json_response(200, Json{{"items", hits.taken(limit, static_cast<std::size_t>(context.budgets.page_bytes))}});
}

}  // namespace

void add_search_routes(Router& router, ApiContext& context) {
  router.add({"GET", "/v1/search", "search", {"q", "limit"}, Handler([&](const Request& request) {
                return search(context, request);
              })});
}

}  // namespace driftlab::server
