#include "server/webhooks/deliverer.hpp"

#include "server/store/guarded_round.hpp"
#include "server/webhooks/pauses.hpp"
#include "server/webhooks/signature.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

constexpr std::chrono::seconds kPoll{1};
constexpr std::int64_t kMicrosPerSecond = 1'000'000;

std::vector<std::string> live_secrets(const Webhook& webhook, UtcMicros now) {
  std::vector<std::string> secrets{webhook.secret};
  if (!webhook.previous_secret.empty() && webhook.previous_until.value_or(0) > now) {
    secrets.push_back(webhook.previous_secret);
  }
  return secrets;
}

/// Why an answer is no success; empty: it is one.
std::string fault_of(const PostAnswer& answer) {
  if (answer.status == 0) {
    return answer.error;
  }
  if (answer.status >= 200 && answer.status < 300) {
    return "";
  }
  const std::string status = std::to_string(answer.status);
  return answer.status >= 300 && answer.status < 400
             ? "The receiver answered with a redirect (" + status + "), which is not followed."
             : "The receiver answered " + status + ".";
}

}  // namespace

Deliverer::Deliverer(WebhookStore& store, const Clock& clock, DelivererOptions options)
    : store_(store), clock_(clock), options_(std::move(options)) {}

Deliverer::~Deliverer() { stop(); }

void Deliverer::start() {
  for (std::int64_t i = 0; i < options_.budgets.webhook_deliveries; ++i) {
    threads_.emplace_back([this] { run(); });
  }
}

void Deliverer::wake() { changed_.notify_all(); }

void Deliverer::stop() {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    stopping_ = true;
  }
  break_off_.request_stop();
  changed_.notify_all();
  for (std::thread& thread : threads_) {
    if (thread.joinable()) {
      thread.join();
    }
  }
}

void Deliverer::run() {
  bool more = true;
  while (more) {
    if (!guarded_round("webhooks", [&] { more = deliver_next(); })) {
      pause();
    }
  }
}

bool Deliverer::deliver_next() {
  const auto due = take();
  if (!due) {
    return false;
  }
  const bool carried_out = guarded_round("webhooks", [&] { deliver(*due); });
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    busy_.erase(std::find(busy_.begin(), busy_.end(), due->webhook.id));
  }
  changed_.notify_all();
  if (!carried_out) {  // it is still due
    pause();
  }
  return true;
}

void Deliverer::pause() {
  std::unique_lock<std::mutex> guard(mutex_);
  changed_.wait_for(guard, kPoll, [this] { return stopping_; });
}

std::optional<DueDelivery> Deliverer::take() {
  std::unique_lock<std::mutex> guard(mutex_);
  while (!stopping_) {
    // Asked under the lock, so that no two threads take the same; it is one look into an index.
    const bool mine = !options_.is_mine || options_.is_mine();
    auto due = mine ? store_.due(busy_).value_or(std::nullopt) : std::nullopt;
    if (due) {
      busy_.push_back(due->webhook.id);
      return due;
    }
    changed_.wait_for(guard, kPoll);
  }
  return std::nullopt;
}

void Deliverer::deliver(const DueDelivery& due) {
  const auto tell = [this](const std::vector<std::string>& webhooks) {
    for (const std::string& id : webhooks) {
      if (options_.disabled) {
        options_.disabled(id);
      }
    }
  };
  if (const auto overfull = store_.disable_overfull(options_.budgets.webhook_waiting); overfull && !overfull->empty()) {
    tell(*overfull);
    return;
  }
  PostAnswer answer;
  const auto destination = options_.guard.read(due.webhook.url);
  if (due.webhook.is_damaged) {
    answer.error = "The row of the webhook is damaged, so that where it leads is not known.";
  } else if (destination) {
    const std::int64_t timestamp_s = clock_.now() / kMicrosPerSecond;
    const WebhookDelivery& message = due.delivery;
    answer = post(options_.guard, *destination,
                  {{"webhook-id", message.id},
                   {"webhook-timestamp", std::to_string(timestamp_s)},
                   {"webhook-signature",
                    webhook_signature(message.id, timestamp_s, message.body, live_secrets(due.webhook, clock_.now()))}},
                  message.body, std::chrono::seconds(options_.budgets.webhook_seconds), break_off_.get_token());
    if (answer.status == 0 && break_off_.stop_requested()) {
      return;
    }
  } else {
    answer.error = destination.error().message;  // it was allowed when the webhook was made
  }
  const DeliveryOutcome outcome = outcome_of(due, answer);
  const auto disabled = store_.record_attempt(due.delivery, outcome);
  if (options_.attempted) {
    options_.attempted(due, outcome.delivered ? "delivered" : outcome.next_at ? "failed" : "given_up", outcome.error);
  }
  if (disabled && *disabled) {
    tell({due.webhook.id});
  }
  if (!disabled) {  // a full disk: it is still due, and the receiver shall not get it again and again
    pause();
  }
}

DeliveryOutcome Deliverer::outcome_of(const DueDelivery& due, const PostAnswer& answer) {
  DeliveryOutcome outcome;
  outcome.error = fault_of(answer);
  outcome.delivered = outcome.error.empty();
  outcome.status = answer.status == 0 ? std::nullopt : std::optional(answer.status);
  outcome.give_ups_until_disabled = static_cast<int>(options_.budgets.webhook_give_ups);
  constexpr int kGone = 410;
  if (answer.status == kGone) {
    outcome.disable_why = "The receiver answered 410: it wants no more.";
    return outcome;
  }
  const int attempts = due.delivery.attempts + 1;
  if (outcome.delivered || attempts >= options_.budgets.webhook_attempts) {
    return outcome;
  }
  const UtcMicros now = clock_.now();
  std::int64_t pause = 0;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    pause = draw_delivery_pause(attempts, options_.budgets.webhook_pause_milliseconds * 1000, jitter_);
  }
  outcome.next_at = now + std::max(pause, retry_after_micros(answer.retry_after, now).value_or(0));
  return outcome;
}

}  // namespace driftlab::server
