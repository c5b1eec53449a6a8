#pragma once
/// The threads that deliver what the outbox holds.
///
/// Each takes the delivery that has been due longest, of a webhook that no other thread is telling something: a
/// receiver gets one message at a time, and a slow receiver does not delay the others. The outcome is written before
/// the next is taken; a daemon that dies in between sends the message again, with the same id. Everything but 2xx is a
/// failure and is tried again after a pause (pauses.hpp); 410 disables the webhook at once, and so do deliveries given
/// up in a row (budgets webhook_attempts, webhook_give_ups). After an exception a thread pauses and goes on
/// (server/store/guarded_round.hpp).
#include "server/store/budgets.hpp"
#include "server/store/webhook_store.hpp"
#include "server/webhooks/destination.hpp"
#include "server/webhooks/post.hpp"

#include <condition_variable>
#include <functional>
#include <mutex>
#include <random>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace driftlab::server {

struct DelivererOptions {
  Budgets budgets = {};
  DestinationGuard guard = {};
  /// Whether this process delivers, of several on one store; empty: it is the only one.
  std::function<bool()> is_mine = {};
  /// Told of every attempt: `delivered`, `failed` or `given_up`, and why it failed. May be empty.
  std::function<void(const DueDelivery& what, std::string_view outcome, const std::string& error)> attempted = {};
  /// Told of every webhook that was disabled. May be empty.
  std::function<void(const std::string& webhook)> disabled = {};
};

class Deliverer {
 public:
  /// References must outlive this object.
  Deliverer(WebhookStore& store, const Clock& clock, DelivererOptions options);
  Deliverer(const Deliverer&) = delete;
  Deliverer& operator=(const Deliverer&) = delete;
  ~Deliverer();

  void start();
  /// There may be something to deliver; without it that is noticed within a second.
  void wake();
  /// Takes nothing more and breaks off what is under way: it is sent again by the next daemon.
  void stop();

 private:
  void run();
  /// Waits for the next delivery and carries it out. False: the end.
  [[nodiscard]] bool deliver_next();
  void pause();
  /// Waits for the next delivery; nothing: the end.
  [[nodiscard]] std::optional<DueDelivery> take();
  void deliver(const DueDelivery& due);
  [[nodiscard]] DeliveryOutcome outcome_of(const DueDelivery& due, const PostAnswer& answer);

  WebhookStore& store_;
  const Clock& clock_;
  const DelivererOptions options_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::string> busy_;  ///< webhooks that are being told something
  std::mt19937_64 jitter_{std::random_device{}()};
  bool stopping_ = false;
  std::stop_source break_off_;
  std::vector<std::thread> threads_;
};

}  // namespace driftlab::server
