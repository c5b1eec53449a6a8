#pragma once
/// What the store keeps about webhooks: who is told of the end of jobs, and the outbox of what is still to be told.
///
/// A delivery is written in the transaction that ends its job (server/store/sql/outbox.cpp), so that none is lost
/// whatever happens to the process, and stays `waiting` until its answer is recorded: a receiver may see it twice, with
/// the same id. Secrets are kept as they are, for signing needs them; whoever can read the database can sign.
/// Methods are thread safe and may block on disk; every one may fail with ErrorCode::Io or DiskFull, and those that
/// read a webhook with damaged_row (damaged_row.hpp); only what is due names one whose row is damaged, so that its
/// attempts end.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"
#include "server/store/store.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

/// What may be told. Every end of a job has one of these; `webhook.test` is sent on request alone.
inline constexpr std::string_view kJobEnded = "job.ended";
inline constexpr std::string_view kRegressionEnded = "regression.ended";
inline constexpr std::string_view kInvestigationEnded = "investigation.ended";
inline constexpr std::string_view kWebhookTest = "webhook.test";

/// The longest pause before another attempt, own or asked for by the receiver. A delivery that would wait longer was
/// put off before the clock went back, and is due.
inline constexpr std::int64_t kLongestDeliveryPauseMicros = 24LL * 3600 * 1'000'000;

struct Webhook {
  std::string id;  ///< `whk_...`
  std::string url;
  std::string description;
  std::vector<std::string> events;
  std::string secret;           ///< `whsec_...`
  std::string previous_secret;  ///< empty: none
  std::optional<UtcMicros> previous_until;
  int given_up = 0;  ///< deliveries given up since the last that arrived
  std::int64_t revision = 1;
  UtcMicros created_at = 0;
  UtcMicros updated_at = 0;
  std::optional<UtcMicros> disabled_at;
  std::string disabled_why;  ///< a sentence; empty: it is enabled
  bool is_damaged = false;   ///< its row is not what was written: nothing is sent to it
};

struct WebhookChange {
  std::optional<std::string> url;
  std::optional<std::string> description;
  std::optional<std::vector<std::string>> events;
  std::optional<bool> enabled;
};

struct WebhookDelivery {
  std::string id;  ///< `msg_...`: the receiver's webhook-id
  std::string webhook_id;
  std::string event;
  std::string job_id;  ///< empty: a test
  std::string body;
  std::string state;  ///< `waiting`, `delivered`, `given_up`
  int attempts = 0;
  UtcMicros next_at = 0;
  UtcMicros created_at = 0;
  std::optional<UtcMicros> ended_at;
  std::optional<int> last_status;  ///< what the receiver answered at the last attempt, where it did
  std::string last_error;          ///< why the last attempt failed; empty: it did not
};

struct DueDelivery {
  Webhook webhook;
  WebhookDelivery delivery;
};

/// How an attempt ended.
struct DeliveryOutcome {
  bool delivered = false;
  std::optional<int> status;
  std::string error;
  std::optional<UtcMicros> next_at;  ///< of the next attempt; nothing, where it was not delivered: it is given up
  std::string disable_why;           ///< the receiver wants no more; empty: it does not say so
  int give_ups_until_disabled = 1;
};

struct WebhookCounts {
  std::int64_t waiting = 0;
  std::int64_t disabled = 0;
};

class WebhookStore {
 public:
  WebhookStore() = default;
  WebhookStore(const WebhookStore&) = delete;
  WebhookStore& operator=(const WebhookStore&) = delete;
  virtual ~WebhookStore() = default;

  [[nodiscard]] virtual Result<std::vector<Webhook>> webhooks(const Page& page) = 0;
  [[nodiscard]] virtual Result<Webhook> webhook(std::string_view id) = 0;
  /// Errors: LimitExceeded where there are `most` already.
  [[nodiscard]] virtual Result<Webhook> add_webhook(const Webhook& webhook, std::int64_t most) = 0;
  /// Enabling forgets why it was disabled; disabling gives up what waits. NotFound; Conflict (field "revision").
  [[nodiscard]] virtual Result<Webhook> change_webhook(std::string_view id, const WebhookChange& change,
                                                       std::int64_t expected_revision) = 0;
  /// Its deliveries go with it, and with Store::kAnyRevision also one whose row is damaged. NotFound; Conflict (field
  /// "revision").
  [[nodiscard]] virtual Status remove_webhook(std::string_view id, std::int64_t expected_revision) = 0;
  /// Another secret; the old one signs too until `previous_until`. NotFound.
  [[nodiscard]] virtual Result<Webhook> rotate_webhook(std::string_view id, std::string_view secret,
                                                       UtcMicros previous_until) = 0;
  /// Queues a `webhook.test`. NotFound; Conflict where it is disabled.
  [[nodiscard]] virtual Result<WebhookDelivery> test_webhook(std::string_view id) = 0;
  [[nodiscard]] virtual Result<std::vector<WebhookDelivery>> deliveries(std::string_view webhook_id,
                                                                        const std::optional<std::string>& state,
                                                                        const Page& page) = 0;

  /// The delivery that has been due longest, of a webhook that is not among `busy`.
  [[nodiscard]] virtual Result<std::optional<DueDelivery>> due(const std::vector<std::string>& busy) = 0;
  /// Writes how an attempt ended. True where this disabled the webhook, whose waiting deliveries are then given up.
  [[nodiscard]] virtual Result<bool> record_attempt(const WebhookDelivery& delivery,
                                                    const DeliveryOutcome& outcome) = 0;
  /// Disables every webhook that has more than `most` deliveries waiting. Their ids.
  [[nodiscard]] virtual Result<std::vector<std::string>> disable_overfull(std::int64_t most) = 0;
  [[nodiscard]] virtual Result<WebhookCounts> webhook_counts() = 0;
  /// Removes deliveries that ended before that time. How many.
  [[nodiscard]] virtual Result<int> forget_deliveries(UtcMicros before) = 0;
};

}  // namespace driftlab::server
