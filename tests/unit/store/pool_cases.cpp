#include "server/store/pool_job.hpp"
#include "tests/unit/store/store_suite.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace driftlab::server {
namespace {

using testing::HasSubstr;

class PoolStore : public StoreSuite {
 protected:
  /// A finished characterise job with a result for each recording.
  std::vector<std::string> finish(const std::vector<Recording>& recordings, const std::string& channel = "gz") {
    add_job(store(), "characterise " + make_id("job", 0), 0);
    const Job job = claim_one(store());
    EXPECT_EQ(job.kind, "characterise");
    JobResults results = results_for(job, recordings.front(), channel);
    for (auto recording = recordings.begin() + 1; recording != recordings.end(); ++recording) {
      results.channels.push_back(results_for(job, *recording, channel).channels.front());
    }
    EXPECT_TRUE(store().succeed(lease_of(job), results)->held);
    std::vector<std::string> members;
    for (const ChannelResult& result : results.channels) {
      members.push_back(result.id);
    }
    return members;
  }
  [[nodiscard]] SensorAxis axis() const { return {device_.id, "angular_rate", "z"}; }
  [[nodiscard]] AxisResults now() { return store().axis_results(axis()).value(); }
  LeaseStatus succeed(const Job& job, const std::string& text) {
    JobResults results;
    results.document_json = text;
    results.pooled = true;
    return store().succeed(lease_of(job), results).value();
  }

  Device device_ = add_device(store());
  Recording first_ = add_recording(store(), device_, "a");
  Recording second_ = add_recording(store(), device_, "b");
  Recording third_ = add_recording(store(), device_, "c", "constant_rate:z:9:deg/s");
};
DRIFTLAB_OVER_ALL_STORES(PoolStore);

TEST_P(PoolStore, AFinishQueuesThePoolingOfItsAxis) {
  finish({first_});
  EXPECT_FALSE(now().pool) << "one result is not pooled";
  finish({second_});
  const AxisResults queued = now();
  ASSERT_TRUE(queued.pool);
  EXPECT_EQ(queued.pool->kind, "pool");
  EXPECT_EQ(queued.pool->state, JobState::Queued);
  EXPECT_EQ(queued.pooled_json, "");
  ASSERT_EQ(queued.latest.size(), 2U);
  for (const ChannelResult& member : queued.latest) {
    EXPECT_THAT(queued.pool->request_json, HasSubstr(member.id));
  }
  const Job job = claim_one(store());
  EXPECT_EQ(job.id, queued.pool->id);
  EXPECT_TRUE(succeed(job, "pooled").held);
  EXPECT_EQ(now().pool->state, JobState::Succeeded);
  EXPECT_EQ(now().pooled_json, "pooled");
  EXPECT_EQ(*store().result_document(job.id), "pooled");
}

TEST_P(PoolStore, AnEqualSetIsOneJob) {
  std::vector<std::string> members = finish({first_, second_});
  const std::string key = now().pool->unique_key;
  EXPECT_EQ(pool_job(axis(), members).unique_key, key);
  std::reverse(members.begin(), members.end());
  EXPECT_EQ(pool_job(axis(), members).unique_key, key);
  EXPECT_FALSE(store().enqueue(pool_job(axis(), members))->created);
}

TEST_P(PoolStore, ANewerSetSupersedesOneThatWaits) {
  finish({first_, second_});
  const Job older = *now().pool;
  clock_.advance(kMinute);
  finish({third_});
  EXPECT_EQ(store().job(older.id)->state, JobState::Cancelled);
  const Job newer = *now().pool;
  EXPECT_NE(newer.id, older.id);
  EXPECT_EQ(newer.state, JobState::Queued);
  EXPECT_EQ(newer.run_at, older.run_at) << "a stream of results does not put the pooling off for ever";
}

TEST_P(PoolStore, TheLatestSetIsKeptWhicheverJobEndsLast) {
  // Two pool jobs of one axis ran at once, and the document of the one that ended last was kept, whatever it was made
  // of.
  for (const bool newer_first : {true, false}) {
    finish({first_, second_});
    const Job older = claim_one(store());
    finish({third_});
    EXPECT_TRUE(store().job(older.id)->cancel_requested);
    const Job newer = claim_one(store());
    if (newer_first) {
      EXPECT_TRUE(succeed(newer, "newer").held);
      EXPECT_TRUE(succeed(older, "older").held);
    } else {
      EXPECT_TRUE(succeed(older, "older").held);
      EXPECT_EQ(now().pooled_json, "");
      EXPECT_TRUE(succeed(newer, "newer").held);
    }
    EXPECT_EQ(now().pooled_json, "newer");
    EXPECT_EQ(store().job(older.id)->state, JobState::Cancelled);
    EXPECT_EQ(store().job(newer.id)->state, JobState::Succeeded);
    EXPECT_FALSE(store().result_document(older.id));
  }
}

TEST_P(PoolStore, AnOlderDocumentIsNotShownForNewResults) {
  finish({first_, second_});
  succeed(claim_one(store()), "of two");
  finish({first_});  // the same recording again: another result
  EXPECT_EQ(now().pooled_json, "");
  EXPECT_EQ(now().pool->state, JobState::Queued);
}

TEST_P(PoolStore, ARemovedRecordingLeavesThePool) {
  finish({first_, second_});
  const Job before = claim_one(store());
  succeed(before, "of two");
  finish({third_});
  const Job with = claim_one(store());
  succeed(with, "of three");
  ASSERT_TRUE(store().remove_recording(third_.id, 1));
  EXPECT_FALSE(store().result_document(with.id)) << "it spoke of the removed recording";
  const AxisResults back = now();
  EXPECT_EQ(back.pooled_json, "");
  ASSERT_TRUE(back.pool);
  EXPECT_EQ(back.pool->state, JobState::Queued) << "the set is the former one, and is pooled again";
  EXPECT_EQ(back.pool->request_json, before.request_json);
  succeed(claim_one(store()), "of two again");
  EXPECT_EQ(now().pooled_json, "of two again");
  ASSERT_TRUE(store().remove_recording(second_.id, 1));
  EXPECT_FALSE(now().pool) << "one result is left";
}

TEST_P(PoolStore, ARevisedRecordingLeavesThePool) {
  finish({first_, second_, third_});
  succeed(claim_one(store()), "of three");
  Recording changed = third_;
  changed.condition = "constant_rate:z:10:deg/s";
  ASSERT_TRUE(store().revise_recording(changed, 1));
  EXPECT_EQ(now().latest.size(), 2U);
  EXPECT_EQ(now().pool->state, JobState::Queued);
  EXPECT_EQ(now().pooled_json, "");
}

TEST_P(PoolStore, ASetThatComesBackWhileItsFormerJobIsEndingIsPooledAnew) {
  finish({first_, second_});
  const Job ending = claim_one(store());
  finish({third_});
  ASSERT_TRUE(store().remove_recording(third_.id, 1));
  const Job again = *now().pool;
  EXPECT_NE(again.id, ending.id);
  EXPECT_EQ(again.state, JobState::Queued);
  EXPECT_TRUE(store().acknowledge_cancel(lease_of(ending))->held);
  EXPECT_EQ(now().pool->state, JobState::Queued);
}

TEST_P(PoolStore, AFailedPoolingIsSeenUntilItIsAskedForAgain) {
  const std::vector<std::string> members = finish({first_, second_});
  ASSERT_TRUE(store().fail_attempt(lease_of(claim_one(store())), {R"({"detail":"no"})"})->held);
  EXPECT_EQ(now().pool->state, JobState::Failed);
  EXPECT_EQ(now().pool->problem_json, R"({"detail":"no"})");
  const auto again = store().enqueue(pool_job(axis(), members));
  ASSERT_TRUE(again && again->created);
  EXPECT_EQ(now().pool->id, again->job.id);
  succeed(claim_one(store()), "pooled");
  EXPECT_EQ(now().pooled_json, "pooled");
}

TEST_P(PoolStore, MembersComeInTheSameOrderHoweverTheyWereStored) {
  // They came by recording id, that is by time of upload: sums over them rounded otherwise after another order.
  finish({second_});
  finish({first_});
  std::vector<std::string> order;
  for (const ChannelResult& result : now().latest) {
    order.push_back(store().recording(result.recording_id)->blob_sha256);
  }
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  const Device other = add_device(store(), "other");
  const Recording b = add_recording(store(), other, "b");
  const Recording a = add_recording(store(), other, "a");
  finish({b, a});
  std::vector<std::string> same;
  const AxisResults others = store().axis_results({other.id, "angular_rate", "z"}).value();
  for (const ChannelResult& result : others.latest) {
    same.push_back(store().recording(result.recording_id)->blob_sha256);
  }
  EXPECT_EQ(same, order);
}

TEST_P(PoolStore, ChannelsWithoutAnAxisAreNotPooled) {
  add_job(store(), "key", 0);
  const Job job = claim_one(store());
  JobResults results = results_for(job, first_);
  results.channels.push_back(results_for(job, second_).channels.front());
  for (ChannelResult& channel : results.channels) {
    channel.axis = "";
  }
  ASSERT_TRUE(store().succeed(lease_of(job), results)->held);
  const auto unnamed = store().axis_results({device_.id, "angular_rate", ""});
  EXPECT_EQ(unnamed->latest.size(), 2U);
  EXPECT_FALSE(unnamed->pool);
}

TEST_P(PoolStore, AnUnfinishedFinishQueuesNothing) {
  finish({first_});
  add_job(store(), "key", 0);
  const Job job = claim_one(store());
  JobResults results = results_for(job, second_);
  results.fits.back().id = results.fits.front().id;  // the last of the inserts breaks a constraint
  ASSERT_FALSE(store().succeed(lease_of(job), results));
  EXPECT_FALSE(now().pool);
  EXPECT_EQ(store().jobs({"pool", {}}, {})->size(), 0U);
}

}  // namespace
}  // namespace driftlab::server
