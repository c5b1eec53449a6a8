// What a job says once it has ended, and what its failed attempts said, is what was written or is not shown.
#include "server/store/damaged_row.hpp"
#include "server/store/retry_policy.hpp"
#include "tests/unit/store/row_suite.hpp"

namespace driftlab::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const AttemptFailure kFinal{R"({"detail":"Too few samples."})", false, false};
const AttemptFailure kPassing{R"({"detail":"The disk is full."})", true, false};

class JobSeals : public RowSuite {
 protected:
  void SetUp() override {
    RowSuite::SetUp();
    rows().tell_damage_to([this](const Error& error) { told_.push_back(damaged_row_of(error)); });
  }

  /// Writes as a fault of the disk would.
  void write(const std::string& sql) {
    const auto written = database().write(WriteKind::Fenced, [&](Connection& c) { return c.prepare(sql).run(); });
    ASSERT_TRUE(written) << written.error().message;
  }

  std::vector<std::string> damaged() {
    std::vector<std::string> found;
    EXPECT_TRUE(
        rows().read_back_rows([](std::size_t) { return true; }, [&](const std::string& row) { found.push_back(row); }));
    return found;
  }

  Job failed_job(const AttemptFailure& failure) {
    add_job(store(), "key");
    const Job job = claim_one(store());
    EXPECT_TRUE(store().report_progress(lease_of(job), "fit WN", 0.5)->held);
    EXPECT_TRUE(store().fail_attempt(lease_of(job), failure)->held);
    return *store().job(job.id);
  }

  Job only_listed() {
    const auto listed = store().jobs({}, {});
    EXPECT_TRUE(listed && listed->size() == 1);
    return listed->front();
  }

  std::vector<std::string> told_;
};

DRIFTLAB_OVER_ALL_STORES(JobSeals);

TEST_P(JobSeals, AFlippedBitInTheProblemOfAFailedJobIsNoticed) {
  const Job job = failed_job(kFinal);
  EXPECT_EQ(job.state, JobState::Failed);
  EXPECT_THAT(damaged(), IsEmpty());
  const std::string row = "jobs/" + job.id;
  const std::vector<std::pair<std::string, std::string>> changes_and_back = {
      {"problem_json = replace(problem_json, 'few', 'fev')", "problem_json = replace(problem_json, 'fev', 'few')"},
      {"stage = 'fit VN'", "stage = 'fit WN'"},
      {"finished_at = finished_at + 1", "finished_at = finished_at - 1"},
      {"failures = 0", "failures = 1"},
      {"cancel_requested = 1", "cancel_requested = 0"},
      {"state = 'cancelled'", "state = 'failed'"},
      {"end_seal = 'a' || end_seal", "end_seal = substr(end_seal, 2)"},
  };
  for (const auto& [change, back] : changes_and_back) {
    write("UPDATE jobs SET " + change);
    told_.clear();
    EXPECT_EQ(damaged_row_of(store().job(job.id).error()), row) << change;
    EXPECT_TRUE(only_listed().is_damaged) << change;
    EXPECT_THAT(told_, ElementsAre(row, row)) << change;
    EXPECT_THAT(damaged(), ElementsAre(row)) << change;
    EXPECT_EQ(*rows().is_damaged(row), std::optional(true)) << change;
    write("UPDATE jobs SET " + back);
    EXPECT_EQ(*rows().is_damaged(row), std::optional(false)) << change;
    EXPECT_EQ(store().job(job.id)->problem_json, kFinal.problem_json) << change;
  }
}

TEST_P(JobSeals, ADamagedAttemptIsNotShown) {
  const Job job = failed_job(kPassing);
  EXPECT_EQ(job.state, JobState::Queued);
  write("UPDATE job_attempts SET problem_json = replace(problem_json, 'full', 'fulm')");
  const std::string row = "job_attempts/" + job.id + "/1";
  EXPECT_EQ(damaged_row_of(store().job(job.id).error()), row);
  EXPECT_TRUE(only_listed().is_damaged);
  EXPECT_THAT(damaged(), ElementsAre(row));
  EXPECT_EQ(*rows().is_damaged(row), std::optional(true));
  EXPECT_EQ(*rows().is_damaged("job_attempts/" + job.id + "/2"), std::optional(false));
  EXPECT_FALSE(store().request_cancel(job.id)) << "it is not shown";
  EXPECT_EQ(only_listed().state, JobState::Cancelled) << "and is cancelled";
}

TEST_P(JobSeals, UntilAJobHasEndedItsProblemIsThatOfItsLastAttempt) {
  const Job job = failed_job(kPassing);
  write("UPDATE jobs SET problem_json = replace(problem_json, 'full', 'fulm')");
  EXPECT_EQ(store().job(job.id)->problem_json, kPassing.problem_json);
  EXPECT_EQ(only_listed().problem_json, kPassing.problem_json);
  NewJob equal;
  equal.kind = job.kind;
  equal.unique_key = job.unique_key;
  equal.request_json = job.request_json;
  EXPECT_EQ(store().enqueue(equal)->job.problem_json, kPassing.problem_json);
  const auto cancelled = store().request_cancel(job.id);
  ASSERT_TRUE(cancelled) << cancelled.error().message;
  EXPECT_EQ(cancelled->state, JobState::Cancelled);
  EXPECT_EQ(cancelled->problem_json, kPassing.problem_json);
  EXPECT_EQ(only_listed().problem_json, kPassing.problem_json);
  EXPECT_THAT(damaged(), IsEmpty());
  EXPECT_THAT(told_, IsEmpty());
}

TEST_P(JobSeals, EveryWayToEndIsSealed) {
  const Recording recording = add_recording(store(), add_device(store()));
  add_job(store(), "cancelled while it waits");
  ASSERT_TRUE(store().request_cancel(only_listed().id));
  add_job(store(), "succeeds");
  const Job succeeds = claim_one(store());
  ASSERT_TRUE(store().succeed(lease_of(succeeds), results_for(succeeds, recording))->held);
  add_job(store(), "cancelled while it runs");
  const Job stopped = claim_one(store());
  ASSERT_TRUE(store().request_cancel(stopped.id));
  ASSERT_TRUE(store().acknowledge_cancel(lease_of(stopped))->held);
  add_job(store(), "its worker dies");
  ASSERT_TRUE(store().request_cancel(claim_one(store()).id));
  ASSERT_TRUE(store().end_all_leases());
  add_job(store(), "dies");
  for (int n = 0; n < kMaxFailures; ++n) {
    ASSERT_TRUE(store().fail_attempt(lease_of(claim_one(store())), kPassing)->held);
    clock_.advance(kLongestPauseMicros);
  }
  const auto jobs = store().jobs({}, {});
  ASSERT_EQ(jobs->size(), 5U);
  EXPECT_THAT(damaged(), IsEmpty());
  write("UPDATE jobs SET attempt = attempt + 1");
  EXPECT_EQ(damaged().size(), 5U);
  for (const Job& job : *jobs) {
    EXPECT_TRUE(is_terminal(job.state));
    EXPECT_FALSE(store().job(job.id));
  }
}

TEST_P(JobSeals, WhatAnEarlierReleaseEndedIsSealedWhenADaemonStarts) {
  const Job job = failed_job(kFinal);
  add_job(store(), "waits");
  write("UPDATE jobs SET end_seal = ''");
  write("UPDATE job_attempts SET seal = ''");
  EXPECT_EQ(store().job(job.id)->problem_json, kFinal.problem_json);
  EXPECT_EQ(*rows().seal_unsealed_rows(), 2) << "the job that waits gets its seal when it ends";
  EXPECT_EQ(*rows().seal_unsealed_rows(), 0);
  EXPECT_THAT(damaged(), IsEmpty());
  write("UPDATE jobs SET problem_json = '{}' WHERE finished_at IS NOT NULL");
  EXPECT_THAT(damaged(), ElementsAre("jobs/" + job.id));
}

TEST_P(JobSeals, ADamagedJobThatHasSucceededIsMadeAnew) {
  const Recording recording = add_recording(store(), add_device(store()));
  const Job job = add_job(store(), "key");
  ASSERT_TRUE(store().succeed(lease_of(claim_one(store())), results_for(job, recording))->held);
  NewJob equal;
  equal.kind = job.kind;
  equal.unique_key = job.unique_key;
  equal.request_json = job.request_json;
  EXPECT_FALSE(store().enqueue(equal)->created);
  write("UPDATE jobs SET started_at = started_at + 1");
  const auto anew = store().enqueue(equal);
  ASSERT_TRUE(anew) << anew.error().message;
  EXPECT_TRUE(anew->created);
  EXPECT_NE(anew->job.id, job.id);
  EXPECT_TRUE(store().job(anew->job.id));
  EXPECT_FALSE(store().job(job.id));
}

TEST_P(JobSeals, AStateThatIsNoneIsNoState) {
  const Job job = failed_job(kFinal);
  write(GetParam().name == "Sqlite" ? "PRAGMA ignore_check_constraints = ON"
                                    : "ALTER TABLE job_events DROP CONSTRAINT job_events_state_check");
  write("UPDATE job_events SET state = 'gailed' WHERE state = 'failed'");
  const auto events = store().events_after(job.id, 0, 10);
  ASSERT_FALSE(events);
  EXPECT_TRUE(damaged_row_of(events.error()).starts_with("job_events/")) << events.error().message;
}

}  // namespace
}  // namespace driftlab::server
