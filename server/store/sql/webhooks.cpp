#include "server/store/sql/seals.hpp"
#include "server/store/sql/webhook_tables.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace driftlab::server::tables {
namespace {

#define DRIFTLAB_WEBHOOK_COLUMNS                                                                                 \
  "id, url, description, events_json, secret, previous_secret, previous_until, given_up, revision, created_at, " \
  "updated_at, disabled_at, disabled_why, seal"

constexpr std::string_view kSelect = "SELECT " DRIFTLAB_WEBHOOK_COLUMNS " FROM webhooks";
constexpr std::string_view kEnabled =
    "SELECT " DRIFTLAB_WEBHOOK_COLUMNS " FROM webhooks WHERE disabled_at IS NULL ORDER BY id";
constexpr std::string_view kById = "SELECT " DRIFTLAB_WEBHOOK_COLUMNS " FROM webhooks WHERE id = ?";
constexpr std::string_view kCount = "SELECT count(*) FROM webhooks";
constexpr std::string_view kInsert =
    "INSERT INTO webhooks (id, url, description, events_json, secret, created_at, updated_at) "
    "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?6)";
constexpr std::string_view kChange =
    "UPDATE webhooks SET url = ?2, description = ?3, events_json = ?4, updated_at = ?5, revision = revision + 1, "
    "seal = '' WHERE id = ?1";
constexpr std::string_view kEnable =
    "UPDATE webhooks SET disabled_at = NULL, disabled_why = '', given_up = 0 WHERE id = ?";
constexpr std::string_view kDisable =
    "UPDATE webhooks SET disabled_at = ?2, disabled_why = ?3, updated_at = ?2, revision = revision + 1 "
    "WHERE id = ?1 AND disabled_at IS NULL";
constexpr std::string_view kGiveUpWaiting =
    "UPDATE webhook_deliveries SET state = 'given_up', ended_at = ?2, last_error = 'The webhook was disabled.' "
    "WHERE webhook_id = ?1 AND state = 'waiting'";
constexpr std::string_view kRemove = "DELETE FROM webhooks WHERE id = ?";
constexpr std::string_view kRotate =
    "UPDATE webhooks SET previous_secret = secret, previous_until = ?3, secret = ?2, updated_at = ?4, "
    "revision = revision + 1, seal = '' WHERE id = ?1";

std::string written(const std::vector<std::string>& events) { return nlohmann::json(events).dump(); }

Webhook read_webhook(const Statement& row) {
  Webhook webhook;
  webhook.id = row.text(0);
  webhook.url = row.text(1);
  webhook.description = row.text(2);
  const auto events = nlohmann::json::parse(row.text(3), nullptr, false);
  if (events.is_array()) {
    webhook.events = events.get<std::vector<std::string>>();
  }
  webhook.secret = row.text(4);
  webhook.previous_secret = row.text(5);
  webhook.previous_until = row.optional_integer(6);
  webhook.given_up = static_cast<int>(row.integer(7));
  webhook.revision = row.integer(8);
  webhook.created_at = row.integer(9);
  webhook.updated_at = row.integer(10);
  webhook.disabled_at = row.optional_integer(11);
  webhook.disabled_why = row.text(12);
  webhook.is_damaged = !seal_fits(row.text(13), seal_of_texts({webhook.id, webhook.url, webhook.description,
                                                               row.text(3), webhook.secret, webhook.previous_secret}));
  return webhook;
}

std::int64_t read_count(const Statement& row) { return row.integer(0); }

/// The webhook, if its revision is the one that the caller read.
Result<Webhook> webhook_as_read(Connection& connection, std::string_view id, std::int64_t expected_revision) {
  auto found = webhook(connection, id);
  if (found && found->revision != expected_revision) {
    return fail(ErrorCode::Conflict, "The webhook was changed meanwhile; read it again.",
                {{"revision", std::to_string(found->revision)}});
  }
  return found;
}

}  // namespace

Result<std::vector<Webhook>> webhooks(Connection& connection, const Page& page) {
  FilteredQuery query(kSelect);
  auto found = query.read_page(connection, page, read_webhook);
  const auto all = found.value_or(std::vector<Webhook>{});
  const auto damaged = std::ranges::find_if(all, &Webhook::is_damaged);
  return damaged == all.end() ? found : fail(damaged_in("webhooks", damaged->id));
}

Result<std::vector<Webhook>> enabled_webhooks(Connection& connection) {
  Statement statement = connection.prepare(kEnabled);
  auto enabled = all_rows(statement, read_webhook);
  if (enabled) {
    std::erase_if(*enabled, &Webhook::is_damaged);
  }
  return enabled;
}

Result<Webhook> any_webhook(Connection& connection, std::string_view id) {
  Statement statement = connection.prepare(kById);
  statement.bind(id);
  return one_row(
      statement, read_webhook,
      {ErrorCode::NotFound, "There is no webhook \"" + std::string(id) + "\".", {{"webhook", std::string(id)}}});
}

Result<Webhook> webhook(Connection& connection, std::string_view id) {
  auto found = any_webhook(connection, id);
  return found && found->is_damaged ? fail(damaged_in("webhooks", id)) : found;
}

Result<Webhook> add_webhook(Connection& connection, const Webhook& webhook, std::int64_t most, UtcMicros now) {
  {
    Statement statement = connection.prepare(kCount);
    const auto count = one_row(statement, read_count, {ErrorCode::Internal, "Webhooks cannot be counted.", {}});
    if (!count) {
      return fail(count.error());
    }
    if (*count >= most) {
      return fail(ErrorCode::LimitExceeded,
                  "There are " + std::to_string(*count) +
                      " webhooks already; delete one first (budget webhooks = " + std::to_string(most) + ").",
                  {{"budget", "webhooks"}});
    }
  }
  const std::string id = make_id("whk", now);
  Statement insert = connection.prepare(kInsert);
  insert.bind(id, webhook.url, webhook.description, written(webhook.events), webhook.secret, now);
  const Status inserted = run_and_seal(connection, "webhooks", insert);
  return inserted ? tables::webhook(connection, id) : fail(inserted.error());
}

Result<Webhook> change_webhook(Connection& connection, std::string_view id, const WebhookChange& change,
                               std::int64_t expected_revision, UtcMicros now) {
  const auto found = webhook_as_read(connection, id, expected_revision);
  if (!found) {
    return fail(found.error());
  }
  Statement update = connection.prepare(kChange);
  update.bind(id, change.url.value_or(found->url), change.description.value_or(found->description),
              written(change.events.value_or(found->events)), now);
  Status changed = run_and_seal(connection, "webhooks", update);
  if (changed && change.enabled) {
    changed = *change.enabled ? connection.prepare(kEnable).bind(id).run()
                              : disable_webhook(connection, id, "It was disabled by hand.", now);
  }
  return changed ? webhook(connection, id) : fail(changed.error());
}

Status remove_webhook(Connection& connection, std::string_view id, std::int64_t expected_revision) {
  const auto found = expected_revision == Store::kAnyRevision ? any_webhook(connection, id)
                                                              : webhook_as_read(connection, id, expected_revision);
  if (!found) {
    return fail(found.error());
  }
  return connection.prepare(kRemove).bind(id).run();
}

Result<Webhook> rotate_webhook(Connection& connection, std::string_view id, std::string_view secret,
                               UtcMicros previous_until, UtcMicros now) {
  if (const auto found = webhook(connection, id); !found) {
    return fail(found.error());
  }
  Statement rotate = connection.prepare(kRotate);
  rotate.bind(id, secret, previous_until, now);
  if (Status rotated = run_and_seal(connection, "webhooks", rotate); !rotated) {
    return fail(rotated.error());
  }
  return webhook(connection, id);
}

Status disable_webhook(Connection& connection, std::string_view id, std::string_view why, UtcMicros now) {
  if (Status disabled = connection.prepare(kDisable).bind(id, now, why).run(); !disabled) {
    return disabled;
  }
  return connection.prepare(kGiveUpWaiting).bind(id, now).run();
}

}  // namespace driftlab::server::tables
