// Webhooks in the store: the outbox belongs to the transaction that ends the job, and a delivery waits until answered.
#include "server/store/sqlite/sqlite_store.hpp"
#include "server/store/webhook_store.hpp"
#include "tests/unit/store/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace driftlab::server {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class WebhookRows : public testing::Test {
 protected:
  WebhookRows() : store_(std::move(open_sqlite_store(directory_.path(), clock_).value())) {}
  WebhookStore& hooks() { return store_->webhooks(); }
  Webhook add(std::vector<std::string> events = {"job.ended", "regression.ended", "investigation.ended"}) {
    Webhook webhook;
    webhook.url = "https://ci.example.org/";
    webhook.events = std::move(events);
    webhook.secret = std::string(8, 's');
    return hooks().add_webhook(webhook, 32).value();
  }
  std::vector<WebhookDelivery> waiting(const Webhook& webhook) {
    return hooks().deliveries(webhook.id, "waiting", {}).value();
  }
  Job run(const std::string& key) {
    add_job(*store_, key);
    return claim_one(*store_);
  }

  FakeClock clock_;
  TemporaryDirectory directory_;
  std::unique_ptr<SqliteStore> store_;
};

TEST_F(WebhookRows, EveryWayAJobEndsIsToldOnce) {
  const Webhook webhook = add();
  const Job succeeded = run("succeeded");
  EXPECT_THAT(waiting(webhook), IsEmpty()) << "a job that runs has not ended";
  ASSERT_TRUE(store_->succeed(lease_of(succeeded), {})->held);
  const Job failed = run("failed");
  ASSERT_TRUE(store_->fail_attempt(lease_of(failed), {R"({"code":"too_few_samples","detail":"Why."})"})->held);
  const Job retried = run("retried");
  ASSERT_TRUE(store_->fail_attempt(lease_of(retried), {"{}", true})->held);
  EXPECT_THAT(waiting(webhook), SizeIs(2)) << "a job that is tried again has not ended";
  ASSERT_TRUE(store_->request_cancel(retried.id));
  const Job running = run("cancelled while it runs");
  ASSERT_TRUE(store_->request_cancel(running.id));
  EXPECT_THAT(waiting(webhook), SizeIs(3));
  ASSERT_EQ(*store_->end_all_leases(), 1);  // put back, and cancelled instead
  const auto told = waiting(webhook);
  ASSERT_THAT(told, SizeIs(4));
  const auto body_of = [&](const Job& job) {  // those of one millisecond come in any order
    const auto found = std::find_if(told.begin(), told.end(), [&](const auto& one) { return one.job_id == job.id; });
    return found == told.end() ? std::string() : found->body;
  };
  EXPECT_THAT(body_of(succeeded), HasSubstr(R"("state":"succeeded")"));
  EXPECT_THAT(body_of(succeeded), HasSubstr("/v1/jobs/" + succeeded.id + "/result"));
  EXPECT_THAT(body_of(failed), HasSubstr(R"("problem":{"code":"too_few_samples","detail":"Why."})"));
  EXPECT_THAT(body_of(retried), HasSubstr(R"("state":"cancelled")"));
  EXPECT_THAT(body_of(running), HasSubstr(R"("state":"cancelled")"));
}

TEST_F(WebhookRows, AWebhookHearsOfItsEventsAlone) {
  const Webhook regressions = add({"regression.ended"});
  ASSERT_TRUE(store_->succeed(lease_of(run("a characterisation")), {})->held);
  EXPECT_THAT(waiting(regressions), IsEmpty());
  ASSERT_TRUE(store_->enqueue({"regress", "a regression", "{}", 5}));
  JobResults results;
  results.document_json = R"({"verdict":"fail"})";
  ASSERT_TRUE(store_->succeed(lease_of(claim_one(*store_)), results)->held);
  const auto told = waiting(regressions);
  ASSERT_THAT(told, SizeIs(1));
  EXPECT_EQ(told[0].event, "regression.ended");
  EXPECT_THAT(told[0].body, HasSubstr(R"("verdict":"fail")"));
}

TEST_F(WebhookRows, PoolingIsTheDaemonsOwnAndNotTold) {
  const Webhook webhook = add();
  ASSERT_TRUE(store_->enqueue({"pool", "pooling", "{}", 5}));
  ASSERT_TRUE(store_->fail_attempt(lease_of(claim_one(*store_)), {"{}"})->held);
  EXPECT_THAT(waiting(webhook), IsEmpty());
}

TEST_F(WebhookRows, WhatIsDueSurvivesTheDaemonAndIsTakenOneByOneForEachWebhook) {
  const Webhook first = add();
  const Webhook second = add();
  ASSERT_TRUE(store_->succeed(lease_of(run("one")), {})->held);
  clock_.advance(kSecond);
  ASSERT_TRUE(store_->succeed(lease_of(run("two")), {})->held);
  store_.reset();
  store_ = std::move(open_sqlite_store(directory_.path(), clock_).value());
  const auto due = hooks().due({});
  ASSERT_TRUE(due && *due);
  const std::string taken = (*due)->webhook.id;  // either: both messages are of one moment
  const std::string other = taken == first.id ? second.id : first.id;
  EXPECT_EQ((*hooks().due({taken}))->webhook.id, other);
  EXPECT_FALSE(*hooks().due({first.id, second.id}));
  DeliveryOutcome later;
  later.error = "No.";
  later.next_at = clock_.now() + kHour;
  ASSERT_FALSE(*hooks().record_attempt((*due)->delivery, later));
  EXPECT_NE((*hooks().due({other}))->delivery.id, (*due)->delivery.id) << "its turn comes later";
  clock_.advance(-48 * kHour);  // the clock went back: nobody waits for it
  EXPECT_TRUE(*hooks().due({other}));
}

TEST_F(WebhookRows, ThoseWhoDoNotListenAreDisabledAndCanBeEnabled) {
  const Webhook webhook = add();
  DeliveryOutcome lost;
  lost.error = "Nobody there.";
  lost.give_ups_until_disabled = 2;
  for (const char* const key : {"one", "two", "three"}) {
    ASSERT_TRUE(store_->succeed(lease_of(run(key)), {})->held);
  }
  EXPECT_FALSE(*hooks().record_attempt((*hooks().due({}))->delivery, lost));
  EXPECT_TRUE(*hooks().record_attempt((*hooks().due({}))->delivery, lost));
  EXPECT_FALSE(*hooks().due({})) << "what waited is given up";
  const Webhook disabled = hooks().webhook(webhook.id).value();
  EXPECT_TRUE(disabled.disabled_at);
  EXPECT_THAT(disabled.disabled_why, HasSubstr("Nobody there."));
  ASSERT_TRUE(store_->succeed(lease_of(run("four")), {})->held);
  EXPECT_THAT(waiting(webhook), IsEmpty());
  EXPECT_EQ(hooks().test_webhook(webhook.id).error().code, ErrorCode::Conflict);
  EXPECT_EQ(hooks().webhook_counts()->disabled, 1);
  WebhookChange enable;
  enable.enabled = true;
  EXPECT_EQ(hooks().change_webhook(webhook.id, enable, webhook.revision).error().code, ErrorCode::Conflict);
  const Webhook enabled = hooks().change_webhook(webhook.id, enable, disabled.revision).value();
  EXPECT_FALSE(enabled.disabled_at);
  EXPECT_EQ(enabled.given_up, 0);
  ASSERT_TRUE(hooks().test_webhook(webhook.id));
  DeliveryOutcome gone;
  gone.status = 410;
  gone.disable_why = "It wants no more.";
  gone.next_at = clock_.now();
  EXPECT_TRUE(*hooks().record_attempt((*hooks().due({}))->delivery, gone));
}

TEST_F(WebhookRows, OneThatArrivesForgivesThoseThatDidNot) {
  const Webhook webhook = add();
  for (const char* const key : {"one", "two"}) {
    ASSERT_TRUE(store_->succeed(lease_of(run(key)), {})->held);
  }
  DeliveryOutcome lost;
  lost.error = "Nobody there.";
  lost.give_ups_until_disabled = 2;
  ASSERT_FALSE(*hooks().record_attempt((*hooks().due({}))->delivery, lost));
  EXPECT_EQ(hooks().webhook(webhook.id)->given_up, 1);
  DeliveryOutcome arrived;
  arrived.delivered = true;
  arrived.status = 204;
  ASSERT_FALSE(*hooks().record_attempt((*hooks().due({}))->delivery, arrived));
  EXPECT_EQ(hooks().webhook(webhook.id)->given_up, 0);
  EXPECT_EQ(*hooks().forget_deliveries(clock_.now() + 1), 2);
  EXPECT_THAT(*hooks().deliveries(webhook.id, std::nullopt, {}), IsEmpty());
}

TEST_F(WebhookRows, AQueueThatGrowsWithoutEndDisables) {
  const Webhook webhook = add();
  for (const char* const key : {"one", "two", "three"}) {
    ASSERT_TRUE(store_->succeed(lease_of(run(key)), {})->held);
  }
  EXPECT_THAT(*hooks().disable_overfull(3), IsEmpty());
  EXPECT_THAT(*hooks().disable_overfull(2), testing::ElementsAre(webhook.id));
  EXPECT_THAT(hooks().webhook(webhook.id)->disabled_why, HasSubstr("webhook_waiting = 2"));
  EXPECT_EQ(hooks().webhook_counts()->waiting, 0);
}

TEST_F(WebhookRows, ARemovedWebhookTakesItsDeliveriesAlongAndThereAreNotMoreThanTheBudget) {
  const Webhook webhook = add();
  ASSERT_TRUE(store_->succeed(lease_of(run("one")), {})->held);
  const WebhookDelivery delivery = (*hooks().due({}))->delivery;
  ASSERT_TRUE(hooks().remove_webhook(webhook.id, webhook.revision));
  EXPECT_FALSE(*hooks().due({}));
  EXPECT_FALSE(*hooks().record_attempt(delivery, {})) << "under way when it was removed";
  EXPECT_EQ(hooks().webhook(webhook.id).error().code, ErrorCode::NotFound);
  EXPECT_EQ(hooks().add_webhook(webhook, 0).error().code, ErrorCode::LimitExceeded);
}

}  // namespace
}  // namespace driftlab::server
