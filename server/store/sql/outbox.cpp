/// Deliveries to webhooks: queued where jobs end, taken when they are due, written down when they were answered.
#include "core/signal/with_count.hpp"
#include "server/store/sql/webhook_tables.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace driftlab::server::tables {
namespace {

using Json = nlohmann::ordered_json;

#define DRIFTLAB_DELIVERY_COLUMNS                                                                      \
  "id, webhook_id, event, job_id, body, state, attempts, next_at, created_at, ended_at, last_status, " \
  "last_error"

constexpr std::string_view kSelect = "SELECT " DRIFTLAB_DELIVERY_COLUMNS " FROM webhook_deliveries";
constexpr std::string_view kById = "SELECT " DRIFTLAB_DELIVERY_COLUMNS " FROM webhook_deliveries WHERE id = ?";
constexpr std::string_view kInsert =
    "INSERT INTO webhook_deliveries (id, webhook_id, event, job_id, body, state, next_at, created_at) "
    "VALUES (?1, ?2, ?3, ?4, ?5, 'waiting', ?6, ?6)";
constexpr std::string_view kAnyEnabled = "SELECT 1 FROM webhooks WHERE disabled_at IS NULL LIMIT 1";
constexpr std::string_view kEnded =
    "SELECT id, kind, state, attempt, finished_at, problem_json FROM jobs "
    "WHERE id = ? AND finished_at IS NOT NULL AND kind <> 'pool'";
constexpr std::string_view kDevices =
    "SELECT devices.name FROM job_devices JOIN devices ON devices.id = device_id WHERE job_id = ? ORDER BY "
    "devices.name";
constexpr std::string_view kInvestigation = "SELECT id FROM investigations WHERE job_id = ? ORDER BY id LIMIT 1";
constexpr std::string_view kDocument = "SELECT document_json FROM job_results WHERE job_id = ?";
/// ?1 now, ?2 webhooks that are being told something, ?3 the longest pause.
constexpr std::string_view kDue = "SELECT " DRIFTLAB_DELIVERY_COLUMNS
                                  " FROM webhook_deliveries WHERE state = 'waiting' AND (next_at <= ?1 OR next_at > "
                                  "?1 + ?3) AND webhook_id NOT IN (SELECT value FROM json_each(?2)) "
                                  "ORDER BY next_at, id LIMIT 1";
constexpr std::string_view kDelivered =
    "UPDATE webhook_deliveries SET state = 'delivered', attempts = attempts + 1, ended_at = ?2, last_status = ?3, "
    "last_error = '' WHERE id = ?1 AND state = 'waiting'";
constexpr std::string_view kArrived = "UPDATE webhooks SET given_up = 0 WHERE id = ? AND given_up > 0";
constexpr std::string_view kTryAgain =
    "UPDATE webhook_deliveries SET attempts = attempts + 1, next_at = ?2, last_status = ?3, last_error = ?4 "
    "WHERE id = ?1 AND state = 'waiting'";
constexpr std::string_view kGivenUp =
    "UPDATE webhook_deliveries SET state = 'given_up', attempts = attempts + 1, ended_at = ?2, last_status = ?3, "
    "last_error = ?4 WHERE id = ?1 AND state = 'waiting'";
constexpr std::string_view kCountGivenUp =
    "UPDATE webhooks SET given_up = given_up + 1 WHERE id = ? AND disabled_at IS NULL RETURNING given_up";
constexpr std::string_view kOverfull =
    "SELECT webhook_id FROM webhook_deliveries WHERE state = 'waiting' GROUP BY webhook_id HAVING count(*) > ?";
constexpr std::string_view kCounts =
    "SELECT (SELECT count(*) FROM webhook_deliveries WHERE state = 'waiting'), "
    "(SELECT count(*) FROM webhooks WHERE disabled_at IS NOT NULL)";
constexpr std::string_view kForget = "DELETE FROM webhook_deliveries WHERE state <> 'waiting' AND ended_at < ?";

std::string read_text(const Statement& row) { return row.text(0); }

std::int64_t read_integer(const Statement& row) { return row.integer(0); }

WebhookDelivery read_delivery(const Statement& row) {
  WebhookDelivery delivery;
  delivery.id = row.text(0);
  delivery.webhook_id = row.text(1);
  delivery.event = row.text(2);
  delivery.job_id = row.text(3);
  delivery.body = row.text(4);
  delivery.state = row.text(5);
  delivery.attempts = static_cast<int>(row.integer(6));
  delivery.next_at = row.integer(7);
  delivery.created_at = row.integer(8);
  delivery.ended_at = row.optional_integer(9);
  const auto status = row.optional_integer(10);
  delivery.last_status = status ? std::optional(static_cast<int>(*status)) : std::nullopt;
  delivery.last_error = row.text(11);
  return delivery;
}

WebhookCounts read_counts(const Statement& row) { return {row.integer(0), row.integer(1)}; }

/// A job at its end, as the message tells of it.
struct EndedJob {
  std::string id, kind, state;
  std::int64_t attempt = 0;
  UtcMicros finished_at = 0;
  std::string problem_json;
};

EndedJob read_ended(const Statement& row) {
  return {row.text(0), row.text(1), row.text(2), row.integer(3), row.integer(4), row.text(5)};
}

std::string_view event_of(std::string_view kind) {
  return kind == "regress" ? kRegressionEnded : kind == "investigate" ? kInvestigationEnded : kJobEnded;
}

Result<std::optional<std::string>> text_for(Connection& connection, std::string_view sql, std::string_view id) {
  Statement statement = connection.prepare(sql);
  statement.bind(id);
  return first_row(statement, read_text);
}

/// Where the result is, and what a regression or an investigation adds.
Status describe_result(Connection& connection, const EndedJob& job, Json& data) {
  data["result"] = nullptr;
  if (job.state != "succeeded") {
    return {};
  }
  data["result"] = "/v1/jobs/" + job.id + "/result";
  const bool investigation = job.kind == "investigate";
  if (!investigation && job.kind != "regress") {
    return {};
  }
  const auto found = text_for(connection, investigation ? kInvestigation : kDocument, job.id);
  if (!found) {
    return fail(found.error());
  }
  const std::string text = found->value_or("");
  if (investigation) {
    data["investigation"] = text.empty() ? Json(nullptr) : Json(text);
    data["result"] = text.empty() ? "/v1/jobs/" + job.id + "/result" : "/v1/investigations/" + text;
  } else {
    const Json document = Json::parse(text, nullptr, false);
    const auto verdict = document.is_object() ? document.find("verdict") : document.end();
    const bool judged =
        verdict != document.end() && verdict->is_string() && !verdict->get_ref<const std::string&>().empty();
    data["verdict"] = judged ? *verdict : Json(nullptr);
    data["result"] = "/v1/regressions/" + job.id;
  }
  return {};
}

/// {"type", "timestamp", "data"} of Standard Webhooks. It says what ended and where to read more, and holds no samples
/// and no results: whoever is told still needs a token to read them.
Result<std::string> message_of(Connection& connection, const EndedJob& job) {
  Json data{{"job", job.id}, {"kind", job.kind}, {"state", job.state}, {"attempt", job.attempt}};
  Statement statement = connection.prepare(kDevices);
  statement.bind(job.id);
  const auto devices = all_rows(statement, read_text);
  if (!devices) {
    return fail(devices.error());
  }
  data["devices"] = *devices;
  data["href"] = "/v1/jobs/" + job.id;
  if (Status described = describe_result(connection, job, data); !described) {
    return fail(described.error());
  }
  const Json problem = Json::parse(job.problem_json, nullptr, false);
  const bool told = job.state != "succeeded" && problem.is_object() && problem.contains("code");
  data["problem"] = told ? Json{{"code", problem["code"]}, {"detail", problem.value("detail", "")}} : Json(nullptr);
  const Json message{{"type", event_of(job.kind)}, {"timestamp", rfc3339(job.finished_at)}, {"data", std::move(data)}};
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

Status fill_outbox(Connection& connection, std::string_view job_id, UtcMicros now) {
  const auto anybody = connection.query_integer(kAnyEnabled);
  if (!anybody || !*anybody) {
    return anybody ? Status{} : fail(anybody.error());
  }
  EndedJob ended;
  {
    Statement statement = connection.prepare(kEnded);
    statement.bind(job_id);
    auto row = first_row(statement, read_ended);
    if (!row) {
      return fail(row.error());
    }
    auto& found = *row;
    if (!found) {
      return {};
    }
    ended = std::move(*found);
  }
  const auto listeners = enabled_webhooks(connection);
  const auto message = message_of(connection, ended);
  if (!listeners || !message) {
    return fail(listeners ? message.error() : listeners.error());
  }
  const std::string_view event = event_of(ended.kind);
  for (const Webhook& webhook : *listeners) {
    if (std::find(webhook.events.begin(), webhook.events.end(), event) == webhook.events.end()) {
      continue;
    }
    if (const auto added = add_delivery(connection, webhook, event, job_id, *message, now); !added) {
      return fail(added.error());
    }
  }
  return {};
}

Result<WebhookDelivery> add_delivery(Connection& connection, const Webhook& webhook, std::string_view event,
                                     std::string_view job_id, const std::string& body, UtcMicros now) {
  const std::string id = make_id("msg", now);
  const Status inserted = connection.prepare(kInsert).bind(id, webhook.id, event, job_id, body, now).run();
  return inserted ? delivery(connection, id) : fail(inserted.error());
}

Result<WebhookDelivery> delivery(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kById);
  statement.bind(id);
  return one_row(statement, read_delivery, {ErrorCode::NotFound, "There is no such delivery.", {}});
}

Result<WebhookDelivery> test_webhook(Connection& connection, std::string_view id, UtcMicros now) {
  const auto found = webhook(connection, id);
  if (!found) {
    return fail(found.error());
  }
  if (found->disabled_at) {
    return fail(ErrorCode::Conflict,
                "The webhook is disabled: " + found->disabled_why + " Enable it by PATCH with {\"enabled\": true}.",
                {{"webhook", found->id}});
  }
  const Json message{{"type", kWebhookTest},
                     {"timestamp", rfc3339(now)},
                     {"data", {{"webhook", found->id}, {"description", found->description}}}};
  return add_delivery(connection, *found, kWebhookTest, "", message.dump(), now);
}

Result<std::vector<WebhookDelivery>> deliveries(Connection& connection, std::string_view webhook_id,
                                                const std::optional<std::string>& state, const Page& page) {
  if (const auto found = webhook(connection, webhook_id); !found) {
    return fail(found.error());
  }
  FilteredQuery query(kSelect);
  query.where("webhook_id = ?", std::string(webhook_id));
  query.where("state = ?", state);
  return query.read_page(connection, page, read_delivery);
}

Result<std::optional<DueDelivery>> due(Connection& connection, const std::vector<std::string>& busy, UtcMicros now) {
  std::optional<WebhookDelivery> next;
  {
    Statement statement = connection.prepare(kDue);
    statement.bind(now, nlohmann::json(busy).dump(), kLongestDeliveryPauseMicros);
    auto row = first_row(statement, read_delivery);
    if (!row) {
      return fail(row.error());
    }
    next = std::move(*row);
  }
  if (!next) {
    return std::optional<DueDelivery>();
  }
  return any_webhook(connection, next->webhook_id).map([&](Webhook found) {
    return std::optional(DueDelivery{std::move(found), std::move(*next)});
  });
}

Result<bool> record_attempt(Connection& connection, const WebhookDelivery& delivery, const DeliveryOutcome& outcome,
                            UtcMicros now) {
  if (outcome.delivered) {
    Status written = connection.prepare(kDelivered).bind(delivery.id, now, outcome.status).run();
    written = written ? connection.prepare(kArrived).bind(delivery.webhook_id).run() : written;
    return written ? Result<bool>(false) : fail(written.error());
  }
  const bool again = outcome.next_at && outcome.disable_why.empty();
  const Status written = connection.prepare(again ? kTryAgain : kGivenUp)
                             .bind(delivery.id, again ? *outcome.next_at : now, outcome.status, outcome.error)
                             .run();
  if (!written || again || connection.changes() == 0) {  // no row: it was removed, or given up, meanwhile
    return written ? Result<bool>(false) : fail(written.error());
  }
  std::string why = outcome.disable_why;
  {
    Statement statement = connection.prepare(kCountGivenUp);
    statement.bind(delivery.webhook_id);
    const auto counted = first_row(statement, read_integer);
    if (!counted) {
      return fail(counted.error());
    }
    const auto& given_up = *counted;
    if (!given_up) {
      return false;
    }
    if (why.empty() && *given_up >= outcome.give_ups_until_disabled) {
      why = with_count(*given_up, "delivery was given up", "deliveries in a row were given up") +
            "; the last attempt: " + outcome.error;
    }
  }
  if (why.empty()) {
    return false;
  }
  const Status disabled = disable_webhook(connection, delivery.webhook_id, why, now);
  return disabled ? Result<bool>(true) : fail(disabled.error());
}

Result<std::vector<std::string>> disable_overfull(Connection& connection, std::int64_t most, UtcMicros now) {
  Result<std::vector<std::string>> overfull = std::vector<std::string>();
  {
    Statement statement = connection.prepare(kOverfull);
    statement.bind(most);
    overfull = all_rows(statement, read_text);
  }
  for (const std::string& id : overfull.value_or(std::vector<std::string>{})) {
    const std::string why = "More deliveries waited than the budget webhook_waiting = " + std::to_string(most) + ".";
    if (Status disabled = disable_webhook(connection, id, why, now); !disabled) {
      return fail(disabled.error());
    }
  }
  return overfull;
}

Result<WebhookCounts> webhook_counts(Connection& connection) {
  Statement statement = connection.prepare(kCounts);
  return one_row(statement, read_counts, {ErrorCode::Internal, "Deliveries cannot be counted.", {}});
}

Result<int> forget_deliveries(Connection& connection, UtcMicros before) {
  if (Status forgotten = connection.prepare(kForget).bind(before).run(); !forgotten) {
    return fail(forgotten.error());
  }
  return connection.changes();
}

}  // namespace driftlab::server::tables
