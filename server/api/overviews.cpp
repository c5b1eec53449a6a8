// What stands on the front of a lab: how much there is, and how each device is.
#include "server/api/overviews.hpp"

#include "core/campaign/glance.hpp"
#include "core/signal/condition.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/reported_channel.hpp"
#include "schema/json/stored_member.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/message.hpp"

#include <map>
#include <utility>

namespace driftlab::server {
namespace {

constexpr int kMostFits = 500;

Json condition_json(const std::string& text) {
  const auto condition = parse_condition(text);
  return condition ? driftlab::to_json(*condition) : Json(nullptr);
}

/// The best fit of an axis under one condition, with what it says at a glance.
struct AxisResult {
  const Fit* fit = nullptr;
  AxisGlance glance;
  [[nodiscard]] AxisCandidate candidate() const { return {fit->condition == "static", glance.level}; }
};

Json to_json(const AxisResult& axis) {
  const Fit& fit = *axis.fit;
  return Json{{"quantity", fit.quantity},
              {"axis", text_or_null(fit.axis)},
              {"recording", fit.recording_id},
              {"condition", condition_json(fit.condition)},
              {"model", fit.model},
              {"N", driftlab::to_json(axis.glance.density)},
              {"fits", axis.glance.fits ? Json(*axis.glance.fits) : Json(nullptr)},
              {"level", name_of(axis.glance.level)},
              {"reason", text_or_null(axis.glance.reason)}};
}

/// The page of the API that holds what the verdict rests on.
std::string address_of(const ResultVerdict& item) {
  return item.recording_id.empty()
             ? result_address(item.kind, item.job_id, item.investigation_id)
             : "/v1/recordings/" + item.recording_id + "/characterisation?channel=" + percent_encode(item.channel);
}

Json to_json(const ResultVerdict& item) {
  return Json{{"id", item.id},
              {"level", item.level},
              {"verdict", item.verdict},
              {"kind", item.kind},
              {"href", address_of(item)},
              {"job", item.job_id},
              {"device", text_or_null(item.device_id)},
              {"device_name", text_or_null(item.device_name)},
              {"recording", text_or_null(item.recording_id)},
              {"channel", text_or_null(item.channel)},
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

/// The newest result of a device: by the verdicts that are kept, or a characterisation of before all of them were.
Json newest_result(const ResultVerdict* said, const Fit* fit) {
  if (said != nullptr && (fit == nullptr || said->created_at >= fit->created_at)) {
    return Json{{"kind", said->kind},
                {"id", !said->recording_id.empty()       ? said->recording_id
                       : !said->investigation_id.empty() ? said->investigation_id
                                                         : said->job_id},
                {"href", address_of(*said)},
                {"job", said->job_id},
                {"recording", text_or_null(said->recording_id)},
                {"at", rfc3339(said->created_at)},
                {"level", said->level},
                {"verdict", said->verdict}};
  }
  if (fit == nullptr) {
    return nullptr;
  }
  return Json{{"kind", "characterise"},
              {"id", fit->recording_id},
              {"href", "/v1/recordings/" + fit->recording_id + "/characterisation"},
              {"job", fit->job_id},
              {"recording", fit->recording_id},
              {"at", rfc3339(fit->created_at)},
              {"level", nullptr},
              {"verdict", nullptr}};
}

Result<Response> get_summary(ApiContext& context, const Request& request) {
  auto device = context.store.device(request.parameters[0]);
  if (!device) {
    return fail(device.error());
  }
  auto summary = device_summary(context.store, device->id);
  if (!summary) {
    return fail(summary.error());
  }
  return json_response(200, *summary);
}

}  // namespace

Result<Json> device_summary(Store& store, const std::string& device_id) {
  auto conditions = store.conditions_of(device_id);
  if (!conditions) {
    return fail(conditions.error());
  }
  FitFilter filter;
  filter.device_id = device_id;
  filter.best_only = true;
  filter.latest_only = true;
  auto fits = store.fits(filter, Page{"", kMostFits});
  if (!fits) {
    return fail(fits.error());
  }
  VerdictFilter any;
  any.device_id = device_id;
  any.to_read = false;
  const auto said = store.verdicts(any, Page{"", 1, PageOrder::NewestFirst});
  if (!said) {
    return fail(said.error());
  }
  std::map<std::pair<std::string, std::string>, AxisResult> axes;
  const Fit* newest = nullptr;
  for (const Fit& fit : *fits) {
    const auto read = stored_fit_from_json(stored(fit.document_json));
    if (!read) {
      return fail(read.error());
    }
    AxisResult found{&fit, glance_of(read->fit, read->density)};
    AxisResult& shown = axes[{fit.quantity, fit.axis}];
    if (shown.fit == nullptr || tells_more(found.candidate(), shown.candidate())) {
      shown = std::move(found);
    }
    if (newest == nullptr || fit.created_at > newest->created_at) {
      newest = &fit;
    }
  }
  std::int64_t recordings = 0;
  Json kinds = Json::array();
  for (const ConditionCount& one : *conditions) {
    recordings += one.recordings;
    kinds.push_back(Json{{"condition", condition_json(one.condition)}, {"recordings", one.recordings}});
  }
  Json channels = Json::array();
  for (const auto& [axis, shown] : axes) {
    channels.push_back(to_json(shown));
  }
  return Json{{"recordings", recordings},
              {"conditions", std::move(kinds)},
              {"channels", std::move(channels)},
              {"latest", newest_result(said->empty() ? nullptr : &said->front(), newest)}};
}

void add_overview_routes(Router& router, ApiContext& context) {
  router.add(from_rows({"GET", "/v1/counts", "getCounts", {"since", "include"}, Handler([&](const Request& r) {
                          return get_counts(context, r);
                        })}));
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
