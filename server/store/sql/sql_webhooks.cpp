#include "server/store/sql/sql_webhooks.hpp"

#include "server/store/sql/seals.hpp"

namespace driftlab::server {
namespace {

std::optional<tables::AuditEntry> entry(const char* action, const std::string& id, const std::string& detail = "") {
  return tables::AuditEntry{action, id, detail};
}

}  // namespace

Result<std::vector<Webhook>> SqlWebhooks::webhooks(const Page& page) {
  return database_.read([&](Connection& c) { return tables::webhooks(c, page); });
}

Result<Webhook> SqlWebhooks::webhook(std::string_view id) {
  return database_.read([&](Connection& c) { return tables::webhook(c, id); });
}

Result<Webhook> SqlWebhooks::add_webhook(const Webhook& webhook, std::int64_t most) {
  return audited_.write([&](Connection& c) { return tables::add_webhook(c, webhook, most, database_.now(c)); },
                        [](const Webhook& made) { return entry("webhook.create", made.id, made.url); });
}

Result<Webhook> SqlWebhooks::change_webhook(std::string_view id, const WebhookChange& change,
                                            std::int64_t expected_revision) {
  return audited_.write(
      [&](Connection& c) { return tables::change_webhook(c, id, change, expected_revision, database_.now(c)); },
      [](const Webhook& changed) { return entry("webhook.change", changed.id, changed.url); });
}

Status SqlWebhooks::remove_webhook(std::string_view id, std::int64_t expected_revision) {
  const auto removed = audited_.write(
      [&](Connection& c) {
        const Status status = tables::remove_webhook(c, id, expected_revision);
        return status ? Result<std::string>(std::string(id)) : fail(status.error());
      },
      [](const std::string& gone) { return entry("webhook.delete", gone); });
  return removed ? Status{} : fail(removed.error());
}

Result<Webhook> SqlWebhooks::rotate_webhook(std::string_view id, std::string_view secret, UtcMicros previous_until) {
  return audited_.write(
      [&](Connection& c) { return tables::rotate_webhook(c, id, secret, previous_until, database_.now(c)); },
      [](const Webhook& changed) { return entry("webhook.rotate", changed.id); });
}

Result<WebhookDelivery> SqlWebhooks::test_webhook(std::string_view id) {
  return audited_.write([&](Connection& c) { return tables::test_webhook(c, id, database_.now(c)); },
                        [](const WebhookDelivery& made) { return entry("webhook.test", made.webhook_id, made.id); });
}

Result<std::vector<WebhookDelivery>> SqlWebhooks::deliveries(std::string_view webhook_id,
                                                             const std::optional<std::string>& state,
                                                             const Page& page) {
  return database_.read([&](Connection& c) { return tables::deliveries(c, webhook_id, state, page); });
}

Result<std::optional<DueDelivery>> SqlWebhooks::due(const std::vector<std::string>& busy) {
  auto next = database_.read([&](Connection& c) { return tables::due(c, busy, database_.now(c)); });
  if (next && *next && (*next)->webhook.is_damaged) {
    database_.tell_damage(damaged_in("webhooks", (*next)->webhook.id));
  }
  return next;
}

Result<bool> SqlWebhooks::record_attempt(const WebhookDelivery& delivery, const DeliveryOutcome& outcome) {
  return database_.write(WriteKind::Serial,
                         [&](Connection& c) { return tables::record_attempt(c, delivery, outcome, database_.now(c)); });
}

Result<std::vector<std::string>> SqlWebhooks::disable_overfull(std::int64_t most) {
  return database_.write(WriteKind::Serial,
                         [&](Connection& c) { return tables::disable_overfull(c, most, database_.now(c)); });
}

Result<WebhookCounts> SqlWebhooks::webhook_counts() {
  return database_.read([](Connection& c) { return tables::webhook_counts(c); });
}

Result<int> SqlWebhooks::forget_deliveries(UtcMicros before) {
  return database_.write(WriteKind::Serial, [&](Connection& c) { return tables::forget_deliveries(c, before); });
}

}  // namespace driftlab::server
