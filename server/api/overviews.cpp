// What stands on the front of a lab: how much there is, and how each device is.
#include "server/api/overviews.hpp"

#include "core/signal/condition.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/stored_member.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/message.hpp"

#include <utility>

namespace driftlab::server {
namespace {

Json condition_json(const std::string& text) {
  const auto condition = parse_condition(text);
  return condition ? driftlab::to_json(*condition) : Json(nullptr);
}

Json to_json(const ShownResult& shown) {
  Json document{{"quantity", shown.quantity},
                {"axis", text_or_null(shown.axis)},
                {"recording", shown.recording_id},
                {"condition", condition_json(shown.condition)}};
  document.update(stored(shown.glance_json));
  return document;
}

/// A verdict on a device among those of its model, which `channel` then names: of a characterisation, but of no
/// recording.
bool is_of_line(const ResultVerdict& item) { return item.recording_id.empty() && !item.channel.empty(); }

std::string kind_of(const ResultVerdict& item) { return is_of_line(item) ? "population" : item.kind; }

/// The page of the API that holds what the verdict rests on.
std::string address_of(const ResultVerdict& item) {
  if (is_of_line(item)) {
    return "/v1/populations?model=" + percent_encode(item.channel);
  }
  return item.recording_id.empty()
             ? result_address(item.kind, item.job_id, item.investigation_id)
             : "/v1/recordings/" + item.recording_id + "/characterisation?channel=" + percent_encode(item.channel);
}

Json to_json(const ResultVerdict& item) {
  return Json{{"id", item.id},
              {"level", item.level},
              {"verdict", item.verdict},
              {"kind", kind_of(item)},
              {"href", address_of(item)},
              {"job", item.job_id},
              {"device", text_or_null(item.device_id)},
              {"device_name", text_or_null(item.device_name)},
              {"recording", text_or_null(item.recording_id)},
              {"channel", is_of_line(item) ? Json(nullptr) : text_or_null(item.channel)},
              {"created_at", rfc3339(item.created_at)}};
}

/// Newest first unless it is asked otherwise: what came last is read first.
Result<Response> list_attention(ApiContext& context, const Request& request) {
  VerdictFilter filter;
  auto device_id = device_filter(context.store, request);
  const auto since = since_filter(request);
  if (!device_id || !since) {
    return fail(device_id ? since.error() : device_id.error());
  }
  filter.device_id = std::move(*device_id);
  filter.since = *since;
  Request asked = request;
  if (!asked.parameter("sort")) {
    asked.query.emplace_back("sort", "-created_at");
  }
  return list_rows(
      asked, [&](const Page& page) { return context.store.verdicts(filter, page); },
      [](const ResultVerdict& item) { return to_json(item); });
}

/// Results to read that stand beside the counts: as many as the first page of a day shows.
constexpr int kMostBesideCounts = 8;

Result<Response> get_counts(ApiContext& context, const Request& request) {
  const auto include = request.parameter("include");
  if (include && *include != "attention") {
    return fail(ErrorCode::InvalidArgument, "What can be included is attention.", {{"parameter", "include"}});
  }
  const auto since = since_filter(request);
  const auto counts = context.store.counts();
  if (!since || !counts) {
    return fail(since ? counts.error() : since.error());
  }
  Json jobs{{"queued", counts->queued}, {"running", counts->running}};
  if (const std::optional<UtcMicros>& at = *since) {
    const auto ended = context.store.ended_since(*at);
    if (!ended) {
      return fail(ended.error());
    }
    jobs["succeeded_since"] = Json{{"at", rfc3339(*at)}, {"count", ended->succeeded}};
    jobs["failed_since"] = Json{{"at", rfc3339(*at)}, {"count", ended->failed}};
  }
  Json document{{"devices", counts->devices}, {"recordings", counts->recordings}, {"jobs", std::move(jobs)}};
  if (include) {
    Request newest = request;
    newest.query = {{"limit", std::to_string(kMostBesideCounts)}};
    auto listed = list_attention(context, newest);
    if (!listed) {
      return listed;
    }
    document["attention"] = stored(listed->body).at("items");
  }
  return json_response(200, document);
}

/// How many jobs run at a time, which no row of the store says.
Result<Response> get_workers(ApiContext& context) {
  const auto workers = context.workers();
  return workers ? Result<Response>(json_response(200, Json{{"workers", *workers}})) : fail(workers.error());
}

/// The newest result of a device: by the verdicts that are kept, or a characterisation of before all of them were.
Json newest_result(const std::optional<ResultVerdict>& said, const std::optional<ChannelResult>& newest) {
  if (said && (!newest || said->created_at >= newest->created_at)) {
    return Json{{"kind", kind_of(*said)},
                {"id", is_of_line(*said)                 ? said->channel
                       : !said->recording_id.empty()     ? said->recording_id
                       : !said->investigation_id.empty() ? said->investigation_id
                                                         : said->job_id},
                {"href", address_of(*said)},
                {"job", said->job_id},
                {"recording", text_or_null(said->recording_id)},
                {"at", rfc3339(said->created_at)},
                {"level", said->level},
                {"verdict", said->verdict}};
  }
  if (!newest) {
    return nullptr;
  }
  return Json{{"kind", "characterise"},
              {"id", newest->recording_id},
              {"href", "/v1/recordings/" + newest->recording_id + "/characterisation"},
              {"job", newest->job_id},
              {"recording", newest->recording_id},
              {"at", rfc3339(newest->created_at)},
              {"level", nullptr},
              {"verdict", nullptr}};
}

Result<Response> get_summary(ApiContext& context, const Request& request) {
  auto device = context.store.device(request.parameters[0]);
  if (!device) {
    return fail(device.error());
  }
  const auto found = context.store.overviews({device->id});
  if (!found) {
    return fail(found.error());
  }
  const auto overview = found->find(device->id);
  if (overview == found->end()) {
    return fail(ErrorCode::NotFound, "There is no device \"" + device->id + "\".");
  }
  return json_response(200, device_summary(overview->second));
}

}  // namespace

Json device_summary(const DeviceOverview& overview) {
  std::int64_t recordings = 0;
  Json kinds = Json::array();
  for (const ConditionCount& one : overview.conditions) {
    recordings += one.recordings;
    kinds.push_back(Json{{"condition", condition_json(one.condition)}, {"recordings", one.recordings}});
  }
  Json channels = Json::array();
  for (const ShownResult& shown : overview.axes) {
    channels.push_back(to_json(shown));
  }
  return Json{{"recordings", recordings},
              {"conditions", std::move(kinds)},
              {"channels", std::move(channels)},
              {"latest", newest_result(overview.verdict, overview.newest)}};
}

void add_overview_routes(Router& router, ApiContext& context) {
  router.add(from_rows({"GET", "/v1/counts", "getCounts", {"since", "include"}, Handler([&](const Request& r) {
                          return get_counts(context, r);
                        })}));
  router.add({"GET", "/v1/workers", "getWorkers", {}, Handler([&](const Request&) { return get_workers(context); })});
  router.add(from_rows({"GET",
                        "/v1/attention",
                        "listAttention",
                        {"limit", "cursor", "sort", "device", "since"},
                        Handler([&](const Request& r) { return list_attention(context, r); })}));
  router.add(from_rows({"GET", "/v1/devices/{id}/summary", "getDeviceSummary", {}, Handler([&](const Request& r) {
                          return get_summary(context, r);
                        })}));
}

}  // namespace driftlab::server
