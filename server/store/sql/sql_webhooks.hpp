#pragma once
/// The webhook store on the transactions of a database.
#include "server/store/sql/sql_access.hpp"
#include "server/store/sql/webhook_tables.hpp"

namespace driftlab::server {

class SqlWebhooks final : public WebhookStore {
 public:
  SqlWebhooks(Database& database, AuditedWriter& audited) : database_(database), audited_(audited) {}

  [[nodiscard]] Result<std::vector<Webhook>> webhooks(const Page& page) override;
  [[nodiscard]] Result<Webhook> webhook(std::string_view id) override;
  [[nodiscard]] Result<Webhook> add_webhook(const Webhook& webhook, std::int64_t most) override;
  [[nodiscard]] Result<Webhook> change_webhook(std::string_view id, const WebhookChange& change,
                                               std::int64_t expected_revision) override;
  [[nodiscard]] Status remove_webhook(std::string_view id, std::int64_t expected_revision) override;
  [[nodiscard]] Result<Webhook> rotate_webhook(std::string_view id, std::string_view secret,
                                               UtcMicros previous_until) override;
  [[nodiscard]] Result<WebhookDelivery> test_webhook(std::string_view id) override;
  [[nodiscard]] Result<std::vector<WebhookDelivery>> deliveries(std::string_view webhook_id,
                                                                const std::optional<std::string>& state,
                                                                const Page& page) override;
  [[nodiscard]] Result<std::optional<DueDelivery>> due(const std::vector<std::string>& busy) override;
  [[nodiscard]] Result<bool> record_attempt(const WebhookDelivery& delivery, const DeliveryOutcome& outcome) override;
  [[nodiscard]] Result<std::vector<std::string>> disable_overfull(std::int64_t most) override;
  [[nodiscard]] Result<WebhookCounts> webhook_counts() override;
  [[nodiscard]] Result<int> forget_deliveries(UtcMicros before) override;

 private:
  Database& database_;
  AuditedWriter& audited_;
};

}  // namespace driftlab::server
