#include "server/store/principal.hpp"
#include "server/store/retry_policy.hpp"
#include "tests/unit/store/store_suite.hpp"

namespace driftlab::server {
namespace {

using JobStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(JobStore);

const AttemptFailure kFinal{R"({"code":"ragged_row"})", false, false};
const AttemptFailure kRetryable{R"({"code":"io"})", true, false};
const AttemptFailure kFault{R"({"code":"internal"})", false, true};

/// Claims the job that must be due after the longest pause.
Job claim_after_pause(Store& store, FakeClock& clock) {
  clock.advance(kLongestPauseMicros);
  return claim_one(store);
}

bool nothing_due(Store& store) {
  const auto claimed = store.claim(kLease);
  return claimed && !claimed->has_value();
}

Job add_job_of(Store& store, const Caller& caller, const std::string& key, int priority = 5) {
  const ActingFor acting(caller);
  return store.enqueue({"characterise", key, "{}", priority})->job;
}

TEST_P(JobStore, ManyJobsOfOneTokenDoNotStandBeforeTheFirstOfAnother) {
  // A CI pipeline queued a thousand recordings; the one of a person came after them all.
  const Caller pipeline = add_caller(store(), "aaaaaaaa");
  const Caller person = add_caller(store(), "bbbbbbbb");
  std::vector<Job> many;
  for (int i = 0; i < 4; ++i) {
    many.push_back(add_job_of(store(), pipeline, "many " + std::to_string(i)));
    clock_.advance(kSecond);
  }
  const Job one = add_job_of(store(), person, "one");
  EXPECT_EQ(claim_one(store()).id, many[0].id) << "nothing runs: the oldest";
  EXPECT_EQ(claim_one(store()).id, one.id);
  EXPECT_EQ(claim_one(store()).id, many[1].id);
  const Job urgent = add_job_of(store(), pipeline, "urgent", 0);
  EXPECT_EQ(claim_one(store()).id, urgent.id) << "two of its token run, and it is five priorities before";
}

TEST_P(JobStore, AJobThatSeveralAskedForIsThatOfTheOneWithTheFewest) {
  const Caller busy = add_caller(store(), "aaaaaaaa");
  const Caller idle = add_caller(store(), "bbbbbbbb");
  add_job_of(store(), busy, "running");
  (void)claim_one(store());
  const Job alone = add_job_of(store(), busy, "alone");
  const Job shared = add_job_of(store(), busy, "shared");
  EXPECT_EQ(add_job_of(store(), idle, "shared").id, shared.id);
  EXPECT_EQ(claim_one(store()).id, shared.id);
  EXPECT_FALSE(store().claim(kLease, 2)->has_value()) << "two of that token run, as many as may";
  EXPECT_EQ(claim_one(store()).id, alone.id);
}

TEST_P(JobStore, AJobOfANewerProgramIsLeftToIt) {
  const auto add = [this](const std::string& kind, const std::string& request) {
    return store().enqueue({kind, kind + request, request, 5})->job.id;
  };
  const std::string later = add("characterise", R"({"algorithm_version":10,"inputs":{}})");
  const std::string unknown = add("foretell", R"({"algorithm_version":1,"inputs":{}})");
  const std::string same = add("characterise", R"({"algorithm_version":9,"inputs":{}})");
  const std::string older = add("characterise", R"({"algorithm_version":8,"inputs":{}})");
  const std::string without = add("pool", R"({"inputs":{}})");
  const std::vector<KnownKind> known = {{"characterise", 9}, {"pool", 1}};
  const std::int64_t many = 1000;
  std::vector<std::string> taken;
  while (const auto job = *store().claim(kLease, many, known)) {
    taken.push_back(job->id);
  }
  EXPECT_THAT(taken, testing::ElementsAre(same, older, without));
  EXPECT_EQ((*store().claim(kLease, many, {{"foretell", 2}}))->id, unknown);
  EXPECT_EQ(store().job(later)->state, JobState::Queued);
  EXPECT_EQ(claim_one(store()).id, later);
}

TEST_P(JobStore, AQueuedJobHoldsWhatWasAskedFor) {
  const auto made = store().enqueue({"characterise", "key", R"({"a":1})", 3});
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->created);
  const auto job = store().job(made->job.id);
  ASSERT_TRUE(job);
  EXPECT_TRUE(is_id(job->id, "job"));
  EXPECT_EQ(job->kind, "characterise");
  EXPECT_EQ(job->state, JobState::Queued);
  EXPECT_EQ(job->request_json, R"({"a":1})");
  EXPECT_EQ(job->unique_key, "key");
  EXPECT_EQ(job->priority, 3);
  EXPECT_EQ(job->attempt, 0);
  EXPECT_EQ(job->max_failures, kMaxFailures);
  EXPECT_EQ(job->created_at, clock_.now());
  EXPECT_FALSE(job->finished_at || job->started_at || job->lease_expires_at);
  EXPECT_EQ(store().job(make_id("job", 0)).error().code, ErrorCode::NotFound);
}

TEST_P(JobStore, ImpossibleJobsAreRefused) {
  EXPECT_EQ(store().enqueue({"characterise", "key", "{}", 10}).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(store().enqueue({"characterise", "key", "{}", -1}).error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(store().enqueue({"characterise", "", "{}"}).error().code, ErrorCode::InvalidArgument);
  EXPECT_TRUE(store().jobs({}, {})->empty());
}

TEST_P(JobStore, AnEqualJobIsTheSameWhileQueuedRunningAndSucceeded) {
  const Job first = add_job(store(), "key");
  const auto again = [&] { return store().enqueue({"characterise", "key", "{}"}); };
  EXPECT_FALSE(again()->created);
  const Job running = claim_one(store());
  EXPECT_FALSE(again()->created);
  ASSERT_TRUE(store().succeed(lease_of(running), {})->held);
  const auto succeeded = again();
  EXPECT_FALSE(succeeded->created);
  EXPECT_EQ(succeeded->job.id, first.id);
  EXPECT_EQ(succeeded->job.state, JobState::Succeeded);
}

TEST_P(JobStore, AnEqualJobIsNewAfterFailureCancelAndDeath) {
  add_job(store(), "failed");
  ASSERT_TRUE(store().fail_attempt(lease_of(claim_one(store())), kFinal)->held);
  add_job(store(), "failed");
  ASSERT_TRUE(store().request_cancel(claim_one(store()).id));

  const Job cancelled = add_job(store(), "cancelled");
  ASSERT_TRUE(store().request_cancel(cancelled.id));
  const Job next = add_job(store(), "cancelled");
  EXPECT_NE(next.id, cancelled.id);
  ASSERT_TRUE(store().request_cancel(next.id));

  add_job(store(), "dead");
  ASSERT_TRUE(store().fail_attempt(lease_of(claim_one(store())), kFault)->held);
  ASSERT_TRUE(store().fail_attempt(lease_of(claim_after_pause(store(), clock_)), kFault)->held);
  add_job(store(), "dead");
}

TEST_P(JobStore, AClaimLeasesTheJobAndRaisesTheAttempt) {
  const Job queued = add_job(store(), "key");
  const Job job = claim_one(store());
  EXPECT_EQ(job.id, queued.id);
  EXPECT_EQ(job.state, JobState::Running);
  EXPECT_EQ(job.attempt, 1);
  EXPECT_EQ(job.lease_expires_at, clock_.now() + kLease);
  EXPECT_EQ(job.started_at, clock_.now());
  EXPECT_TRUE(nothing_due(store()));
}

TEST_P(JobStore, ClaimsGoByPriorityThenByTimeThenById) {
  const Job late_urgent = add_job(store(), "urgent", 0);
  const Job low = add_job(store(), "low", 9);
  const Job twin = add_job(store(), "twin", 9);
  clock_.advance(kSecond);
  const Job later = add_job(store(), "later", 9);
  EXPECT_EQ(claim_one(store()).id, late_urgent.id);
  EXPECT_EQ(claim_one(store()).id, std::min(low.id, twin.id));
  EXPECT_EQ(claim_one(store()).id, std::max(low.id, twin.id));
  EXPECT_EQ(claim_one(store()).id, later.id);
}

TEST_P(JobStore, AWaitingJobRisesByOnePriorityEveryTenMinutes) {
  const Job patient = add_job(store(), "patient", 5);
  clock_.advance(2 * kAgeingMicros - 1);  // risen by one: 4
  const Job urgent = add_job(store(), "urgent", 3);
  EXPECT_EQ(claim_one(store()).id, urgent.id);
  clock_.advance(1);  // risen by two: 3, and older
  add_job(store(), "urgent again", 3);
  EXPECT_EQ(claim_one(store()).id, patient.id);
}

TEST_P(JobStore, ARenewedLeaseLasts) {
  add_job(store(), "key");
  const Job job = claim_one(store());
  clock_.advance(kLease / 2);
  EXPECT_TRUE(store().renew(lease_of(job), kLease)->held);
  clock_.advance(kLease - 1);
  EXPECT_EQ(*store().rescue_expired(), 0);
  EXPECT_EQ(store().job(job.id)->state, JobState::Running);
  clock_.advance(1);
  EXPECT_EQ(*store().rescue_expired(), 1);
  EXPECT_EQ(store().job(job.id)->state, JobState::Queued);
}

TEST_P(JobStore, ALostLeaseFencesEveryWriteOfTheOldWorker) {
  const Recording recording = add_recording(store(), add_device(store()));
  add_job(store(), "key");
  const Job old_claim = claim_one(store());
  clock_.advance(kLease);
  ASSERT_EQ(*store().rescue_expired(), 1);
  const Job new_claim = claim_one(store());
  ASSERT_EQ(new_claim.id, old_claim.id);
  EXPECT_EQ(new_claim.attempt, old_claim.attempt + 1);
  EXPECT_EQ(new_claim.failures, 0) << "a lost lease is no failure";

  const Lease stale = lease_of(old_claim);
  const std::size_t history = store().events_after(old_claim.id, 0, 100)->size();
  EXPECT_FALSE(store().renew(stale, kLease)->held);
  EXPECT_FALSE(store().report_progress(stale, "late", 0.9)->held);
  EXPECT_FALSE(store().succeed(stale, results_for(old_claim, recording))->held);
  EXPECT_FALSE(store().fail_attempt(stale, kFinal)->held);
  EXPECT_FALSE(store().acknowledge_cancel(stale)->held);
  EXPECT_FALSE(store().release(stale)->held);
  const auto job = store().job(old_claim.id);
  EXPECT_EQ(job->state, JobState::Running);
  EXPECT_EQ(job->stage, "");
  EXPECT_TRUE(job->attempt_problems_json.empty());
  EXPECT_EQ(job->lease_expires_at, clock_.now() + kLease);
  EXPECT_EQ(store().events_after(old_claim.id, 0, 100)->size(), history);
  EXPECT_TRUE(store().fits({}, {})->empty());

  EXPECT_TRUE(store().succeed(lease_of(new_claim), results_for(new_claim, recording))->held);
  EXPECT_EQ(store().fits({}, {})->size(), 2U);
}

TEST_P(JobStore, AFinishedJobTakesNoMoreWrites) {
  const Recording recording = add_recording(store(), add_device(store()));
  add_job(store(), "key");
  const Job job = claim_one(store());
  ASSERT_TRUE(store().succeed(lease_of(job), results_for(job, recording))->held);
  EXPECT_FALSE(store().succeed(lease_of(job), results_for(job, recording))->held);
  EXPECT_FALSE(store().fail_attempt(lease_of(job), kFinal)->held);
  EXPECT_EQ(store().fits({}, {})->size(), 2U);
  EXPECT_EQ(store().request_cancel(job.id)->state, JobState::Succeeded);
}

TEST_P(JobStore, ProgressIsKeptInRangeAndNeverFalls) {
  add_job(store(), "key");
  const Job job = claim_one(store());
  const auto progress_after = [&](double reported) {
    EXPECT_TRUE(store().report_progress(lease_of(job), "fit WN", reported)->held);
    return store().job(job.id)->progress;
  };
  EXPECT_EQ(progress_after(0.5), 0.5);
  EXPECT_EQ(progress_after(0.25), 0.5);
  EXPECT_EQ(progress_after(std::nan("")), 0.5);
  EXPECT_EQ(progress_after(-3.0), 0.5);
  EXPECT_EQ(progress_after(7.0), 1.0);
  EXPECT_EQ(store().job(job.id)->stage, "fit WN");
}

TEST_P(JobStore, AFinalFailureFailsAtOnceAndKeepsItsProblem) {
  add_job(store(), "key");
  const Job job = claim_one(store());
  ASSERT_TRUE(store().fail_attempt(lease_of(job), kFinal)->held);
  const auto failed = store().job(job.id);
  EXPECT_EQ(failed->state, JobState::Failed);
  EXPECT_EQ(failed->problem_json, kFinal.problem_json);
  EXPECT_EQ(failed->finished_at, clock_.now());
  EXPECT_FALSE(failed->lease_expires_at);
  EXPECT_THAT(failed->attempt_problems_json, testing::ElementsAre(kFinal.problem_json));
  clock_.advance(kLongestPauseMicros);
  EXPECT_TRUE(nothing_due(store()));
}

TEST_P(JobStore, ARetryableFailureWaitsAtMostFourToTheNSecondsAndDiesAtTheFifth) {
  add_job(store(), "key");
  for (int n = 1; n <= kMaxFailures; ++n) {
    const Job job = n == 1 ? claim_one(store()) : claim_after_pause(store(), clock_);
    EXPECT_EQ(job.attempt, n);
    EXPECT_EQ(job.progress, 0.0);
    ASSERT_TRUE(store().report_progress(lease_of(job), "read", 0.5));
    ASSERT_TRUE(store().fail_attempt(lease_of(job), {R"({"n":)" + std::to_string(n) + "}", true})->held);
    const auto failed = store().job(job.id);
    EXPECT_EQ(failed->failures, n);
    if (n < kMaxFailures) {
      EXPECT_EQ(failed->state, JobState::Queued);
      EXPECT_EQ(failed->progress, 0.0);
      EXPECT_GE(failed->run_at, clock_.now());
      EXPECT_LE(failed->run_at, clock_.now() + pause_bound_micros(n));
    } else {
      EXPECT_EQ(failed->state, JobState::Dead);
      EXPECT_EQ(failed->finished_at, clock_.now());
      EXPECT_THAT(failed->attempt_problems_json,
                  testing::ElementsAre(R"({"n":1})", R"({"n":2})", R"({"n":3})", R"({"n":4})", R"({"n":5})"));
    }
  }
}

TEST_P(JobStore, AFailedJobIsNotClaimedBeforeItsPauseIsOver) {
  for (int i = 0; i < 20; ++i) {  // some draws are close to 0; not all of 20
    add_job(store(), "key" + std::to_string(i));
    ASSERT_TRUE(store().fail_attempt(lease_of(claim_one(store())), kRetryable)->held);
  }
  UtcMicros latest = 0;
  int due = 0;
  const auto failed = store().jobs({}, {});
  for (const Job& job : *failed) {
    latest = std::max(latest, job.run_at);
    due += job.run_at <= clock_.now() ? 1 : 0;
  }
  EXPECT_LT(due, 20) << "every pause was drawn as 0";
  clock_.advance(latest - clock_.now() - 1);
  int claimed = 0;
  while (!nothing_due(store())) {
    ++claimed;
  }
  EXPECT_EQ(claimed, 19);
  clock_.advance(1);
  EXPECT_FALSE(nothing_due(store()));
}

TEST_P(JobStore, TwoFaultSignalsMakeAJobPoison) {
  add_job(store(), "key");
  const Job first = claim_one(store());
  ASSERT_TRUE(store().fail_attempt(lease_of(first), kFault)->held);
  EXPECT_EQ(store().job(first.id)->state, JobState::Queued) << "once may be chance";
  ASSERT_TRUE(store().fail_attempt(lease_of(claim_after_pause(store(), clock_)), kFault)->held);
  EXPECT_EQ(store().job(first.id)->state, JobState::Dead);
  EXPECT_EQ(store().job(first.id)->attempt_problems_json.size(), 2U);
}

TEST_P(JobStore, HandingBackAndLosingLeasesNeverKills) {
  const Job job = add_job(store(), "key");
  for (int i = 0; i < 3 * kMaxFailures; ++i) {
    const Job claimed = claim_one(store());
    if (i % 3 == 0) {
      ASSERT_TRUE(store().release(lease_of(claimed))->held);
    } else if (i % 3 == 1) {
      clock_.advance(kLease);
      ASSERT_EQ(*store().rescue_expired(), 1);
    } else {
      ASSERT_EQ(*store().end_all_leases(), 1);
    }
  }
  EXPECT_EQ(store().job(job.id)->state, JobState::Queued);
  EXPECT_EQ(store().job(job.id)->failures, 0);
  EXPECT_EQ(store().job(job.id)->attempt, 3 * kMaxFailures);
}

TEST_P(JobStore, ARestartEndsEveryLeaseWhateverTheClockSays) {
  add_job(store(), "one");
  add_job(store(), "two");
  add_job(store(), "three");
  claim_one(store());
  claim_one(store());
  clock_.advance(-kHour);
  reopen();
  EXPECT_EQ(*store().end_all_leases(), 2);
  EXPECT_EQ(*store().end_all_leases(), 0);
  JobFilter queued;
  queued.state = JobState::Queued;
  EXPECT_EQ(store().jobs(queued, {})->size(), 3U);
}

TEST_P(JobStore, AClockSetBackStallsNeitherNewNorFailedJobs) {
  const Job fresh = add_job(store(), "fresh");
  clock_.advance(-10 * kHour);
  EXPECT_EQ(claim_one(store()).id, fresh.id);
  ASSERT_TRUE(store().fail_attempt({fresh.id, 1}, kRetryable)->held);
  clock_.advance(-10 * kHour);
  EXPECT_EQ(claim_one(store()).id, fresh.id);
  ASSERT_TRUE(store().succeed({fresh.id, 2}, {})->held);
  EXPECT_EQ(store().job(fresh.id)->state, JobState::Succeeded);
  const auto events = store().events_after(fresh.id, 0, 100);
  ASSERT_TRUE(events);
  for (std::size_t i = 1; i < events->size(); ++i) {
    EXPECT_GT((*events)[i].sequence, (*events)[i - 1].sequence);
  }
  EXPECT_EQ(events->back().state, JobState::Succeeded);
}

TEST_P(JobStore, EventsTellTheHistoryInOrderAndResume) {
  add_job(store(), "other");
  const Job other = claim_one(store());
  const Job queued = add_job(store(), "key");
  const Job job = claim_one(store());
  ASSERT_EQ(job.id, queued.id);
  ASSERT_TRUE(store().report_progress(lease_of(job), "variance", 0.25));
  ASSERT_TRUE(store().report_progress(lease_of(other), "variance", 0.5));
  ASSERT_TRUE(store().report_progress(lease_of(job), "fit WN", 0.75));
  ASSERT_TRUE(store().succeed(lease_of(job), {}));
  const auto events = store().events_after(job.id, 0, 100);
  ASSERT_TRUE(events);
  ASSERT_EQ(events->size(), 5U);
  const auto told = [&](std::size_t i) {
    const JobEvent& event = (*events)[i];
    return event.type + " " + std::string(name_of(event.state)) + " " + event.stage;
  };
  EXPECT_EQ(told(0), "state queued ");
  EXPECT_EQ(told(1), "state running ");
  EXPECT_EQ(told(2), "progress running variance");
  EXPECT_EQ(told(3), "progress running fit WN");
  EXPECT_EQ(told(4), "state succeeded ");
  EXPECT_EQ((*events)[3].progress, 0.75);
  EXPECT_EQ((*events)[4].progress, 1.0);
  EXPECT_EQ((*events)[1].attempt, 1);
  const auto rest = store().events_after(job.id, (*events)[2].sequence, 1);
  ASSERT_EQ(rest->size(), 1U);
  EXPECT_EQ((*rest)[0].sequence, (*events)[3].sequence);
  EXPECT_TRUE(store().events_after(job.id, events->back().sequence, 100)->empty());
}

TEST_P(JobStore, ListsByKindAndState) {
  add_job(store(), "one");
  ASSERT_TRUE(store().enqueue({"other", "two", "{}", 0}));
  claim_one(store());
  JobFilter filter;
  filter.kind = "other";
  EXPECT_EQ(store().jobs(filter, {})->size(), 1U);
  filter.state = JobState::Queued;
  EXPECT_TRUE(store().jobs(filter, {})->empty());
  filter.state = JobState::Running;
  EXPECT_EQ(store().jobs(filter, {})->size(), 1U);
  EXPECT_EQ(store().jobs({}, {})->size(), 2U);
  EXPECT_EQ(store().jobs({}, {"", 1})->size(), 1U);
}

}  // namespace
}  // namespace driftlab::server
