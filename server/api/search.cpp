// Finding by the beginning of a name or by an id: what the find field of the pages asks.
#include "server/api/api.hpp"
#include "server/api/documents.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace driftlab::server {
namespace {

constexpr int kRowsAtOnce = 500;

std::string in_lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return c < 128 ? static_cast<char>(std::tolower(c)) : static_cast<char>(c); });
  return lower;
}

Json hit(std::string_view kind, const std::string& id, const std::string& title, const std::string& subtitle,
         const std::string& href) {
  return Json{{"kind", kind}, {"id", id}, {"title", title}, {"subtitle", subtitle}, {"href", href}};
}

/// The one object whose whole id was typed; null where there is none.
Json by_id(Store& store, const std::string& id) {
  if (const auto device = store.device(id); id.starts_with("dev_") && device) {
    return hit("device", device->id, device->name, "device", "/v1/devices/" + device->id);
  }
  if (const auto recording = store.recording(id); id.starts_with("rec_") && recording) {
    const Json name = stored(recording->metadata_json).value("id", Json(nullptr));
    return hit("recording", recording->id, name.is_string() ? name.get<std::string>() : recording->id,
               "recording, " + recording->condition, "/v1/recordings/" + recording->id);
  }
  if (const auto job = store.job(id); id.starts_with("job_") && job) {
    return hit("job", job->id, job->kind, "job, " + std::string(name_of(job->state)), "/v1/jobs/" + job->id);
  }
  if (const auto model = store.model(id); id.starts_with("mod_") && model) {
    return hit("model", model->id, model->name, "model", "/v1/models/" + model->id);
  }
  if (const auto found = store.investigation(id); id.starts_with("inv_") && found) {
    return hit("investigation", found->id, found->id, "investigation", "/v1/investigations/" + found->id);
  }
  return nullptr;
}

/// Devices whose name begins with the text, then those that have it further on, each in the order of their making.
Result<std::vector<Json>> devices_like(Store& store, const std::string& wanted, std::size_t most) {
  std::array<std::vector<Json>, 2> found;
  Page page{"", kRowsAtOnce};
  while (true) {
    const auto devices = store.devices(page);
    if (!devices) {
      return fail(devices.error());
    }
    for (const Device& device : *devices) {
      const std::size_t place = in_lower_case(device.name).find(wanted);
      if (place != std::string::npos && found[place == 0 ? 0 : 1].size() < most) {
        found[place == 0 ? 0 : 1].push_back(hit("device", device.id, device.name,
                                                device.model.empty() ? "device" : "device, " + device.model,
                                                "/v1/devices/" + device.id));
      }
    }
    if (devices->size() < static_cast<std::size_t>(kRowsAtOnce) || found[0].size() >= most) {
      break;
    }
    page.after = devices->back().id;
  }
  found[0].insert(found[0].end(), found[1].begin(), found[1].end());
  found[0].resize(std::min(found[0].size(), most));
  return std::move(found[0]);
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
  Json items = Json::array();
  if (Json exact = by_id(context.store, text); !exact.is_null()) {
    items.push_back(std::move(exact));
  }
  auto devices = devices_like(context.store, in_lower_case(text), limit);
  if (!devices) {
    return fail(devices.error());
  }
  for (Json& device : *devices) {
    if (items.size() < limit && device["id"] != text) {
      items.push_back(std::move(device));
    }
  }
  return json_response(200, Json{{"items", std::move(items)}});
}

}  // namespace

void add_search_routes(Router& router, ApiContext& context) {
  router.add({"GET", "/v1/search", "search", {"q", "limit"}, Handler([&](const Request& request) {
                return search(context, request);
              })});
}

}  // namespace driftlab::server
