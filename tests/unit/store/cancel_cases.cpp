#include "tests/unit/store/store_suite.hpp"

namespace driftlab::server {
namespace {

using CancelStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(CancelStore);

const AttemptFailure kFinal{"{}", false, false};
const AttemptFailure kRetryable{"{}", true, false};

Job running_with_request(Store& store) {
  add_job(store, "key");
  const Job job = claim_one(store);
  const auto asked = store.request_cancel(job.id);
  EXPECT_TRUE(asked);
  EXPECT_EQ(asked->state, JobState::Running);
  EXPECT_TRUE(asked->cancel_requested);
  return job;
}

void expect_cancelled(Store& store, const std::string& id) {
  const auto job = store.job(id);
  EXPECT_EQ(job->state, JobState::Cancelled);
  EXPECT_TRUE(job->finished_at.has_value());
  EXPECT_FALSE(job->lease_expires_at.has_value());
  EXPECT_EQ(store.events_after(id, 0, 100)->back().state, JobState::Cancelled);
}

TEST_P(CancelStore, AQueuedJobIsCancelledAtOnce) {
  const Job job = add_job(store(), "key");
  EXPECT_EQ(store().request_cancel(job.id)->state, JobState::Cancelled);
  expect_cancelled(store(), job.id);
  EXPECT_FALSE(store().claim(kLease)->has_value());
}

TEST_P(CancelStore, ARunningJobLearnsItByEveryWriteAndEndsWhenItsWorkerSaysSo) {
  const Job job = running_with_request(store());
  EXPECT_TRUE(store().renew(lease_of(job), kLease)->cancel_requested);
  EXPECT_TRUE(store().report_progress(lease_of(job), "fit", 0.1)->cancel_requested);
  EXPECT_TRUE(store().acknowledge_cancel(lease_of(job))->held);
  expect_cancelled(store(), job.id);
}

TEST_P(CancelStore, WithoutARequestThereIsNothingToAcknowledge) {
  add_job(store(), "key");
  const Job job = claim_one(store());
  const auto status = store().acknowledge_cancel(lease_of(job));
  EXPECT_TRUE(status->held);
  EXPECT_FALSE(status->cancel_requested);
  EXPECT_EQ(store().job(job.id)->state, JobState::Running);
}

TEST_P(CancelStore, AResultThatIsThereFirstStays) {
  const Job job = running_with_request(store());
  EXPECT_TRUE(store().succeed(lease_of(job), {"{}", {}, {}})->held);
  EXPECT_EQ(store().job(job.id)->state, JobState::Succeeded);
  EXPECT_EQ(*store().result_document(job.id), "{}");
}

TEST_P(CancelStore, AJobThatWouldGoBackToTheQueueIsCancelledInstead) {
  const Job failed = running_with_request(store());
  EXPECT_TRUE(store().fail_attempt(lease_of(failed), kRetryable)->held);
  expect_cancelled(store(), failed.id);

  const Job released = running_with_request(store());
  EXPECT_TRUE(store().release(lease_of(released))->held);
  expect_cancelled(store(), released.id);

  const Job expired = running_with_request(store());
  clock_.advance(kLease);
  EXPECT_EQ(*store().rescue_expired(), 1);
  expect_cancelled(store(), expired.id);

  const Job restarted = running_with_request(store());
  EXPECT_EQ(*store().end_all_leases(), 1);
  expect_cancelled(store(), restarted.id);
}

TEST_P(CancelStore, AFinalFailureIsToldAsOne) {
  const Job job = running_with_request(store());
  EXPECT_TRUE(store().fail_attempt(lease_of(job), kFinal)->held);
  EXPECT_EQ(store().job(job.id)->state, JobState::Failed);
}

TEST_P(CancelStore, ATerminalJobIsLeftAsItIs) {
  add_job(store(), "key");
  const Job job = claim_one(store());
  ASSERT_TRUE(store().fail_attempt(lease_of(job), kFinal)->held);
  const auto history = store().events_after(job.id, 0, 100)->size();
  const auto asked = store().request_cancel(job.id);
  EXPECT_EQ(asked->state, JobState::Failed);
  EXPECT_FALSE(asked->cancel_requested);
  EXPECT_EQ(store().events_after(job.id, 0, 100)->size(), history);
  EXPECT_EQ(store().request_cancel(make_id("job", 0)).error().code, ErrorCode::NotFound);
}

TEST_P(CancelStore, AskingTwiceIsAskingOnce) {
  const Job job = running_with_request(store());
  EXPECT_TRUE(store().request_cancel(job.id)->cancel_requested);
  EXPECT_TRUE(store().acknowledge_cancel(lease_of(job))->held);
  EXPECT_EQ(store().request_cancel(job.id)->state, JobState::Cancelled);
}

}  // namespace
}  // namespace driftlab::server
