#pragma once
/// What the webhook store does inside a transaction (see tables.hpp), and the outbox that every end of a job fills.
#include "server/store/sql/tables.hpp"
#include "server/store/webhook_store.hpp"

namespace driftlab::server::tables {

// ---- outbox
/// Queues a delivery for every enabled webhook that wants to know of the end of this job; nothing where the job has
/// not ended. Called with every change of a job's state, in its transaction.
[[nodiscard]] Status fill_outbox(Connection& connection, std::string_view job_id, UtcMicros now);
[[nodiscard]] Result<WebhookDelivery> add_delivery(Connection& connection, const Webhook& webhook,
                                                   std::string_view event, std::string_view job_id,
                                                   const std::string& body, UtcMicros now);

// ---- webhooks
[[nodiscard]] Result<std::vector<Webhook>> webhooks(Connection& connection, const Page& page);
/// Those that are told what ends; one whose row is damaged is not.
[[nodiscard]] Result<std::vector<Webhook>> enabled_webhooks(Connection& connection);
/// Whether its row is sound or not. NotFound.
[[nodiscard]] Result<Webhook> any_webhook(Connection& connection, std::string_view id);
[[nodiscard]] Result<Webhook> webhook(Connection& connection, std::string_view id);
[[nodiscard]] Result<Webhook> add_webhook(Connection& connection, const Webhook& webhook, std::int64_t most,
                                          UtcMicros now);
[[nodiscard]] Result<Webhook> change_webhook(Connection& connection, std::string_view id, const WebhookChange& change,
                                             std::int64_t expected_revision, UtcMicros now);
[[nodiscard]] Status remove_webhook(Connection& connection, std::string_view id, std::int64_t expected_revision);
[[nodiscard]] Result<Webhook> rotate_webhook(Connection& connection, std::string_view id, std::string_view secret,
                                             UtcMicros previous_until, UtcMicros now);
[[nodiscard]] Status disable_webhook(Connection& connection, std::string_view id, std::string_view why, UtcMicros now);

// ---- deliveries
[[nodiscard]] Result<WebhookDelivery> test_webhook(Connection& connection, std::string_view id, UtcMicros now);
[[nodiscard]] Result<WebhookDelivery> delivery(Connection& connection, std::string_view id);
[[nodiscard]] Result<std::vector<WebhookDelivery>> deliveries(Connection& connection, std::string_view webhook_id,
                                                              const std::optional<std::string>& state,
                                                              const Page& page);
[[nodiscard]] Result<std::optional<DueDelivery>> due(Connection& connection, const std::vector<std::string>& busy,
                                                     UtcMicros now);
[[nodiscard]] Result<bool> record_attempt(Connection& connection, const WebhookDelivery& delivery,
                                          const DeliveryOutcome& outcome, UtcMicros now);
[[nodiscard]] Result<std::vector<std::string>> disable_overfull(Connection& connection, std::int64_t most,
                                                                UtcMicros now);
[[nodiscard]] Result<WebhookCounts> webhook_counts(Connection& connection);
[[nodiscard]] Result<int> forget_deliveries(Connection& connection, UtcMicros before);

}  // namespace driftlab::server::tables
