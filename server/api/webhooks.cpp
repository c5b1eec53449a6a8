#include "schema/json/json.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/problem.hpp"
#include "server/store/damaged_row.hpp"
#include "server/webhooks/signature.hpp"

#include <algorithm>
#include <array>

namespace driftlab::server {
namespace {

constexpr std::array<std::string_view, 3> kEvents{kJobEnded, kRegressionEnded, kInvestigationEnded};
constexpr std::array<std::string_view, 3> kStates{"waiting", "delivered", "given_up"};
constexpr UtcMicros kOldSecretMicros = 24LL * 3600 * 1'000'000;

Json moment(const std::optional<UtcMicros>& time) { return time ? Json(rfc3339(*time)) : Json(nullptr); }

Json to_json(const Webhook& webhook) {
  return Json{{"id", webhook.id},
              {"url", webhook.url},
              {"description", webhook.description},
              {"events", webhook.events},
              {"enabled", !webhook.disabled_at.has_value()},
              {"disabled_at", moment(webhook.disabled_at)},
              {"disabled_why", webhook.disabled_at ? Json(webhook.disabled_why) : Json(nullptr)},
              {"given_up", webhook.given_up},
              {"previous_secret_until", moment(webhook.previous_until)},
              {"revision", webhook.revision},
              {"created_at", rfc3339(webhook.created_at)},
              {"updated_at", rfc3339(webhook.updated_at)}};
}

Json to_json(const WebhookDelivery& delivery) {
  const bool waits = delivery.state == "waiting";
  return Json{{"id", delivery.id},
              {"webhook", delivery.webhook_id},
              {"type", delivery.event},
              {"job", delivery.job_id.empty() ? Json(nullptr) : Json(delivery.job_id)},
              {"state", delivery.state},
              {"attempts", delivery.attempts},
              {"next_attempt_at", waits ? Json(rfc3339(delivery.next_at)) : Json(nullptr)},
              {"last_status", delivery.last_status ? Json(*delivery.last_status) : Json(nullptr)},
              {"last_error", delivery.last_error.empty() ? Json(nullptr) : Json(delivery.last_error)},
              {"message", stored(delivery.body)},
              {"created_at", rfc3339(delivery.created_at)},
              {"ended_at", moment(delivery.ended_at)}};
}

Response webhook_response(int status, const Webhook& webhook, const Json& document) {
  Response response = json_response(status, document);
  response.headers.emplace_back("ETag", etag_of(webhook.id, webhook.revision));
  return response;
}

/// The one answer that has the secret.
Response issued_response(int status, const Webhook& webhook) {
  Json document = to_json(webhook);
  document["secret"] = webhook.secret;
  Response response = webhook_response(status, webhook, document);
  response.headers.emplace_back("Cache-Control", "no-store");
  response.headers.emplace_back("Location", "/v1/webhooks/" + webhook.id);
  return response;
}

std::optional<std::vector<std::string>> read_events(ObjectReader& reader, Faults& faults) {
  const Json* const listed = reader.member("events");
  if (listed == nullptr) {
    return std::nullopt;
  }
  std::vector<std::string> events;
  bool sound = listed->is_array() && !listed->empty() && listed->size() <= kEvents.size();
  if (sound) {
    for (const Json& event : *listed) {
      const std::string name = event.is_string() ? event.get<std::string>() : "";
      sound = sound && std::find(kEvents.begin(), kEvents.end(), name) != kEvents.end() &&
              std::find(events.begin(), events.end(), name) == events.end();
      events.push_back(name);
    }
  }
  if (!sound) {
    faults.add(reader.pointer("events"), ErrorCode::InvalidArgument,
               "The events are a list of job.ended, regression.ended and investigation.ended, each once.");
  }
  return events;
}

std::optional<bool> read_switch(ObjectReader& reader, std::string_view name, Faults& faults) {
  const Json* const value = reader.member(name);
  if (value != nullptr && !value->is_boolean()) {
    faults.add(reader.pointer(name), ErrorCode::InvalidArgument, "This is true or false.");
    return std::nullopt;
  }
  return value == nullptr ? std::nullopt : std::optional(value->get<bool>());
}

/// What the body says of a webhook, to make one or to change one.
WebhookChange read_change(ApiContext& context, ObjectReader& reader, Faults& faults) {
  WebhookChange change;
  change.url = reader.text("url");
  if (change.url) {
    limit_text(*change.url, "note_bytes", context.budgets.note_bytes, reader.pointer("url"), faults);
    if (const auto destination = context.webhook_guard.read(*change.url); !destination) {
      faults.add(reader.pointer("url"), destination.error());
    }
  }
  change.description = reader.text("description");
  limit_text(change.description.value_or(""), "note_bytes", context.budgets.note_bytes, reader.pointer("description"),
             faults);
  change.events = read_events(reader, faults);
  return change;
}

Result<Response> create_webhook(ApiContext& context, const Request& request) {
  auto wanted = read_body(request, [&](ObjectReader& reader, Faults& faults) {
    WebhookChange members = read_change(context, reader, faults);
    if (!members.url && faults.none()) {
      faults.add("/url", ErrorCode::InvalidArgument, "This member is missing.");
    }
    return members;
  });
  if (!wanted) {
    return fail(wanted.error());
  }
  Webhook webhook;
  webhook.url = wanted->url.value_or("");
  webhook.description = wanted->description.value_or("");
  webhook.events = wanted->events.value_or(std::vector<std::string>(kEvents.begin(), kEvents.end()));
  webhook.secret = make_webhook_secret();
  const auto made = context.webhooks->add_webhook(webhook, context.budgets.webhooks);
  return made ? Result<Response>(issued_response(201, *made)) : fail(made.error());
}

Result<Response> list_webhooks(ApiContext& context, const Request& request) {
  return list_rows(
      request, [&](const Page& page) { return context.webhooks->webhooks(page); },
      [](const Webhook& webhook) { return to_json(webhook); });
}

Result<Response> get_webhook(ApiContext& context, const Request& request) {
  return context.webhooks->webhook(request.parameters[0]).map([](const Webhook& webhook) {
    return webhook_response(200, webhook, to_json(webhook));
  });
}

Result<Response> patch_webhook(ApiContext& context, const Request& request) {
  const auto webhook = context.webhooks->webhook(request.parameters[0]);
  if (!webhook) {
    return fail(webhook.error());
  }
  const auto revision = expected_revision(request, webhook->id, webhook->revision);
  if (!revision) {
    return revision.error();
  }
  const auto change = read_body(request, [&](ObjectReader& reader, Faults& faults) {
    WebhookChange members = read_change(context, reader, faults);
    members.enabled = read_switch(reader, "enabled", faults);
    return members;
  });
  if (!change) {
    return fail(change.error());
  }
  const auto changed = context.webhooks->change_webhook(webhook->id, *change, *revision);
  return changed ? Result<Response>(webhook_response(200, *changed, to_json(*changed))) : fail(changed.error());
}

Result<Response> delete_webhook(ApiContext& context, const Request& request) {
  const auto webhook = context.webhooks->webhook(request.parameters[0]);
  if (!webhook && !damaged_row_of(webhook.error()).empty() && request.header("if-match") == "*") {
    return removed_response(context.webhooks->remove_webhook(request.parameters[0], Store::kAnyRevision));
  }
  if (!webhook) {
    return fail(webhook.error());
  }
  const auto revision = expected_revision(request, webhook->id, webhook->revision);
  if (!revision) {
    return revision.error();
  }
  return removed_response(context.webhooks->remove_webhook(webhook->id, *revision));
}

Result<Response> rotate_webhook(ApiContext& context, const Request& request) {
  const UtcMicros until = context.clock.now() + kOldSecretMicros;
  const auto rotated = context.webhooks->rotate_webhook(request.parameters[0], make_webhook_secret(), until);
  return rotated ? Result<Response>(issued_response(200, *rotated)) : fail(rotated.error());
}

Result<Response> test_webhook(ApiContext& context, const Request& request) {
  const auto queued = context.webhooks->test_webhook(request.parameters[0]);
  if (!queued) {
    return fail(queued.error());
  }
  if (context.wake_deliveries) {
    context.wake_deliveries();
  }
  return json_response(202, to_json(*queued));
}

Result<Response> list_deliveries(ApiContext& context, const Request& request) {
  std::optional<std::string> state;
  if (const auto wanted = request.parameter("state")) {
    if (std::find(kStates.begin(), kStates.end(), *wanted) == kStates.end()) {
      return fail(ErrorCode::InvalidArgument, "A delivery is waiting, delivered or given_up.",
                  {{"parameter", "state"}});
    }
    state = *wanted;
  }
  return list_rows(
      request, [&](const Page& page) { return context.webhooks->deliveries(request.parameters[0], state, page); },
      [](const WebhookDelivery& delivery) { return to_json(delivery); });
}

}  // namespace

void add_webhook_routes(Router& router, ApiContext& context) {
  const auto route = [&](std::string_view method, std::string_view path, std::string_view operation,
                         std::vector<std::string_view> query, Result<Response> (*answer)(ApiContext&, const Request&)) {
    return Route{method, path, operation, std::move(query),
                 Handler([&context, answer](const Request& request) { return answer(context, request); })};
  };
  router.add(route("GET", "/v1/webhooks", "listWebhooks", {"limit", "cursor", "sort"}, list_webhooks));
  Route create = route("POST", "/v1/webhooks", "createWebhook", {}, create_webhook);
  create.secret = true;
  router.add(std::move(create));
  router.add(route("GET", "/v1/webhooks/{id}", "getWebhook", {}, get_webhook));
  router.add(route("PATCH", "/v1/webhooks/{id}", "changeWebhook", {}, patch_webhook));
  router.add(route("DELETE", "/v1/webhooks/{id}", "deleteWebhook", {}, delete_webhook));
  Route rotate = route("POST", "/v1/webhooks/{id}/rotate", "rotateWebhook", {}, rotate_webhook);
  rotate.secret = true;
  router.add(std::move(rotate));
  router.add(route("POST", "/v1/webhooks/{id}/test", "testWebhook", {}, test_webhook));
  router.add(route("GET", "/v1/webhooks/{id}/deliveries", "listDeliveries", {"limit", "cursor", "sort", "state"},
                   list_deliveries));
}

}  // namespace driftlab::server
