#include "core/campaign/regression/kept_settings.hpp"
#include "schema/json/recording_tags.hpp"
#include "schema/json/regression.hpp"
#include "schema/json/stored_member.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"
#include "server/jobs/regression_memory.hpp"

namespace driftlab::server {
namespace {

/// The test that shows the candidate furthest beyond its margin: what a list says of a run.
Json worst_test(const Json& document) {
  Json worst = nullptr;
  const Json units = document.value("units", Json::array());
  for (const Json& unit : units) {
    for (const Json& test : unit["tests"]) {
      const bool further = test["ci"][0].is_number() && test["margin"].is_number() &&
                           (worst.is_null() || test["ci"][0].get<double>() / test["margin"].get<double>() >
                                                   worst["ci"][0].get<double>() / worst["margin"].get<double>());
      if (further) {
        worst = Json{{"sensor", unit["sensor"]}, {"axis", unit["axis"]}};
        for (const char* const member : {"kind", "tau_s", "name", "ratio", "ci", "margin", "gated", "verdict"}) {
          if (test.contains(member)) {
            worst[member] = test[member];
          }
        }
      }
    }
  }
  return worst;
}

/// What a run says of one parameter: its tests, of every axis that has it.
Json parameter_tests(const Json& document, std::string_view name) {
  Json tests = Json::array();
  for (const Json& unit : document.value("units", Json::array())) {
    for (const Json& test : unit["tests"]) {
      if (test.value("kind", "") == "parameter" && test.value("name", "") == name) {
        tests.push_back(Json{{"sensor", unit["sensor"]}, {"axis", unit["axis"]}, {"condition", unit["condition"]}});
        for (const char* const member : {"name", "ratio", "ci", "margin", "gated", "verdict"}) {
          tests.back()[member] = test[member];
        }
      }
    }
  }
  return tests;
}

/// How much the sessions scatter, of the document: the factors of spec/regression.md (3).
Json scatter_of(const Json& document) {
  const Json between = document.value("between", Json());
  return between.is_object() && between.contains("kL") ? Json{{"kL", between.at("kL")}, {"kS", between.at("kS")}}
                                                       : Json(nullptr);
}

/// A run is its job; its document is the job's result. `parameter`: whose tests are told.
Json listed(ApiContext& context, const Job& job, const std::optional<std::string>& parameter) {
  Json item{{"id", job.id},
            {"state", name_of(job.state)},
            {"device", nullptr},
            {"device_name", text_or_null(job.device_name)},
            {"baseline", nullptr},
            {"candidate", nullptr},
            {"verdict", nullptr},
            {"summary", nullptr},
            {"look", nullptr},
            {"needs", nullptr},
            {"worst", nullptr},
            {"between", nullptr},
            {"created_at", rfc3339(job.created_at)}};
  const Json request = job.is_damaged ? Json(nullptr) : stored(job.request_json);
  if (request.is_object()) {
    item["device"] = request["inputs"]["device"];
    item["baseline"] = request["inputs"]["baseline"]["label"];
    item["candidate"] = request["inputs"]["candidate"]["label"];
    item["look"] = request["look"]["number"];
  }
  if (parameter) {
    item["parameters"] = Json::array();
  }
  if (job.state == JobState::Succeeded) {
    if (const auto text = context.store.result_document(job.id)) {
      const Json document = stored(*text);
      item["verdict"] = document["verdict"];
      item["summary"] = document["summary"];
      item["needs"] = document["needs"];
      item["worst"] = worst_test(document);
      item["between"] = scatter_of(document);
      if (parameter) {
        item["parameters"] = parameter_tests(document, *parameter);
      }
    }
  }
  return item;
}

/// `firmware=1.5.0` of a query or document, its parts in the order of their names as runs have it.
Result<std::string> label_named(std::string_view text) {
  const auto labels = parse_labels(text);
  if (!labels) {
    return fail(labels.error());
  }
  return label_text(Json(*labels));
}

Result<Response> list_regressions(ApiContext& context, const Request& request) {
  JobFilter filter;
  filter.kind = "regress";
  auto device_id = device_filter(context.store, request);
  if (!device_id) {
    return fail(device_id.error());
  }
  filter.input_device = std::move(*device_id);
  if (const auto text = request.parameter("label")) {
    auto label = label_named(*text);
    if (!label) {
      return fail(label.error());
    }
    filter.candidate = std::move(*label);
  }
  const auto named = request.parameter("parameter");
  const auto parameter = named ? std::optional(std::string(*named)) : std::nullopt;
  return list_rows(
      request, [&](const Page& page) { return context.store.jobs(filter, page); },
      [&](const Job& job) { return listed(context, job, parameter); });
}

/// The job of a run. Error: NotFound, also for a job of another kind.
Result<Job> regression_job(ApiContext& context, const Request& request) {
  auto job = context.store.job(request.parameters[0]);
  if (job && job->kind != "regress") {
    return fail(ErrorCode::NotFound, "The job " + job->id + " is no regression run.", {{"job", job->id}});
  }
  return job;
}

/// What a run made under that name, as `content_type`.
Result<Response> artefact_response(ApiContext& context, const Job& job, std::string_view name,
                                   const char* content_type) {
  auto content = context.store.artefact(job.id, name);
  if (!content) {
    return fail(content.error());
  }
  Response response;
  response.content_type = content_type;
  response.body = std::move(*content);
  return response;
}

Result<Response> get_regression(ApiContext& context, const Request& request) {
  const auto type = negotiate(request.header("accept"), {"application/json", "text/plain", "text/markdown"});
  if (!type) {
    return problem_response(HttpFault::NotAcceptable, "Offered are application/json, text/plain and text/markdown.");
  }
  const auto job = regression_job(context, request);
  if (!job) {
    return fail(job.error());
  }
  Result<Response> answer = fail(ErrorCode::Internal, "");
  if (*type == "text/plain") {
    answer = artefact_response(context, *job, "text", "text/plain; charset=utf-8");
  } else if (*type == "text/markdown") {
    answer = artefact_response(context, *job, "markdown", "text/markdown; charset=utf-8");
    constexpr std::string_view kPlace = "(FIGURE)";
    if (const std::size_t at = answer ? answer->body.find(kPlace) : std::string::npos; at != std::string::npos) {
      answer->body.replace(at, kPlace.size(), "(/v1/regressions/" + job->id + "/figure)");
    }
  } else {
    auto document = context.store.result_document(job->id);
    answer = document ? Result<Response>(json_response(200, stored(*document))) : fail(document.error());
  }
  if (answer) {
    answer->headers.emplace_back("Vary", "Accept");
  }
  return answer;
}

/// The JUnit report; what is open is an error, or with `?inconclusive=pass` skipped.
Result<Response> get_junit(ApiContext& context, const Request& request) {
  const std::string_view open = request.parameter("inconclusive").value_or("fail");
  if (open != "pass" && open != "fail") {
    return fail(ErrorCode::InvalidArgument, "inconclusive is pass or fail.", {{"parameter", "inconclusive"}});
  }
  const auto job = regression_job(context, request);
  const char* const name = open == "pass" ? "junit_open_skipped" : "junit";
  return job ? artefact_response(context, *job, name, "text/xml; charset=utf-8") : fail(job.error());
}

/// `figure` and `badge`.
Result<Response> get_drawing(ApiContext& context, const Request& request, std::string_view name) {
  const auto job = regression_job(context, request);
  return job ? artefact_response(context, *job, name, "image/svg+xml; charset=utf-8") : fail(job.error());
}

Json to_json(const Anchor& anchor) {
  return Json{{"id", anchor.id},
              {"device", anchor.device_id},
              {"label", anchor.label},
              {"reason", anchor.reason},
              {"settings", anchor.settings_json.empty() ? Json(nullptr) : stored(anchor.settings_json)},
              {"created_at", rfc3339(anchor.created_at)}};
}

Result<Response> list_anchors(ApiContext& context, const Request& request) {
  auto device_id = device_filter(context.store, request);
  if (!device_id) {
    return fail(device_id.error());
  }
  return list_rows(
      request, [&](const Page& page) { return context.store.anchors(*device_id, page); },
      [](const Anchor& anchor) { return to_json(anchor); });
}

Result<Response> move_anchor(ApiContext& context, const Request& request) {
  auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  ObjectReader reader(*body, "", faults);
  const std::string device_name = reader.required_text("device");
  const std::string label = reader.required_text("label");
  Anchor anchor;
  anchor.reason = reader.required_text("reason");
  limit_text(anchor.reason, "note_bytes", request.budgets->note_bytes, reader.pointer("reason"), faults);
  limit_text(label, "note_bytes", request.budgets->note_bytes, reader.pointer("label"), faults);
  WrittenRegression given;
  const Json* const settings = reader.member("settings");
  if (settings != nullptr) {
    regression_settings_from_json(*settings, reader.pointer("settings"), given, faults);
  }
  reader.reject_unknown();
  auto named = label_named(label);
  if (!named && faults.none()) {
    faults.add("/label", named.error());
  }
  if (anchor.reason.empty() && faults.none()) {
    faults.add("/reason", ErrorCode::InvalidArgument, "Say why the baseline moves.");
  }
  if (!faults.none()) {
    return fail(faults.error());
  }
  anchor.label = std::move(*named);
  auto device = context.store.device(device_name);
  if (!device) {
    return fail(device.error());
  }
  const auto memory = RegressionMemory::of(context.store, *device);
  const auto found = memory ? memory->recordings(anchor.label, "/label") : fail(memory.error());
  if (!found) {
    return fail(found.error());
  }
  if (found->empty()) {
    auto sentence = memory->unknown_label(anchor.label);
    return sentence ? fail(ErrorCode::NotFound, std::move(*sentence), {{"label", anchor.label}})
                    : fail(sentence.error());
  }
  // What is not named stays as it was with the anchor before.
  const auto kept = memory->kept_settings();
  if (!kept) {
    return fail(kept.error());
  }
  const auto& before = *kept;
  anchor.settings_json = to_text(
      kept_settings_json(before ? regression::with_kept(*before, given.settings, given.stated) : given.settings));
  anchor.device_id = device->id;
  auto moved = context.store.add_anchor(anchor);
  return moved ? Result<Response>(json_response(201, to_json(*moved))) : fail(moved.error());
}

}  // namespace

void add_regression_routes(Router& router, ApiContext& context) {
  router.add({"GET",
              "/v1/regressions",
              "listRegressions",
              {"limit", "cursor", "sort", "device", "label", "parameter"},
              Handler([&](const Request& request) { return list_regressions(context, request); })});
  router.add({"GET", "/v1/regressions/{id}", "getRegression", {}, Handler([&](const Request& request) {
                return get_regression(context, request);
              })});
  router.add({"GET",
              "/v1/regressions/{id}/junit",
              "getRegressionJunit",
              {"inconclusive"},
              Handler([&](const Request& request) { return get_junit(context, request); })});
  router.add({"GET", "/v1/regressions/{id}/figure", "getRegressionFigure", {}, Handler([&](const Request& request) {
                return get_drawing(context, request, "figure");
              })});
  router.add({"GET", "/v1/regressions/{id}/badge", "getRegressionBadge", {}, Handler([&](const Request& request) {
                return get_drawing(context, request, "badge");
              })});
  router.add({"GET",
              "/v1/regression-anchors",
              "listRegressionAnchors",
              {"limit", "cursor", "sort", "device"},
              Handler([&](const Request& request) { return list_anchors(context, request); })});
  router.add({"POST", "/v1/regression-anchors", "moveRegressionAnchor", {}, Handler([&](const Request& request) {
                return move_anchor(context, request);
              })});
}

}  // namespace driftlab::server
