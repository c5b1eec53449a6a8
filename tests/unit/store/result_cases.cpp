#include "tests/unit/store/store_suite.hpp"

namespace driftlab::server {
namespace {

using ResultStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(ResultStore);

/// A finished job over `recording` with results for `channel`, which is about `axis`.
JobResults finish_job(Store& store, const Recording& recording, const std::string& channel = "gz",
                      const std::string& axis = "z") {
  add_job(store, "key " + make_id("job", 0));
  const Job job = claim_one(store);
  JobResults results = results_for(job, recording, channel);
  results.channels.at(0).axis = axis;
  EXPECT_TRUE(store.succeed(lease_of(job), results)->held);
  for (Fit& fit : results.fits) {
    fit.job_id = job.id;
  }
  return results;
}

TEST_P(ResultStore, AFinishWritesDocumentChannelsAndFits) {
  const Recording recording = add_recording(store(), add_device(store()));
  add_job(store(), "key");
  const Job job = claim_one(store());
  const JobResults results = results_for(job, recording);
  EXPECT_EQ(store().result_document(job.id).error().code, ErrorCode::NotFound);
  ASSERT_TRUE(store().succeed(lease_of(job), results)->held);

  const auto done = store().job(job.id);
  EXPECT_EQ(done->state, JobState::Succeeded);
  EXPECT_EQ(done->progress, 1.0);
  EXPECT_EQ(done->finished_at, clock_.now());
  EXPECT_EQ(*store().result_document(job.id), results.document_json);
  const auto fit = store().fit(results.fits[0].id);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->job_id, job.id);
  EXPECT_EQ(fit->device_id, recording.device_id);
  EXPECT_EQ(fit->recording_id, recording.id);
  EXPECT_EQ(fit->channel, "gz");
  EXPECT_EQ(fit->quantity, "angular_rate");
  EXPECT_EQ(fit->axis, "z");
  EXPECT_EQ(fit->condition, "static");
  EXPECT_EQ(fit->model, "WN+GM");
  EXPECT_EQ(fit->document_json, R"({"model":"WN+GM"})");
  const auto channels = store().latest_channel_results(recording.device_id, "angular_rate", "z");
  ASSERT_EQ(channels->size(), 1U);
  EXPECT_EQ((*channels)[0].id, results.channels[0].id);
  EXPECT_EQ((*channels)[0].settings_json, R"({"seed":1})");
  EXPECT_EQ((*channels)[0].document_json, R"({"channel":"gz"})");
  EXPECT_EQ(store().fit(make_id("fit", 0)).error().code, ErrorCode::NotFound);
}

TEST_P(ResultStore, AFinishThatFailsHalfWayWritesNothing) {
  const Recording recording = add_recording(store(), add_device(store()));
  add_job(store(), "key");
  const Job job = claim_one(store());
  JobResults results = results_for(job, recording);
  results.fits.back().id = results.fits.front().id;  // the last of the inserts breaks a constraint
  const auto finished = store().succeed(lease_of(job), results);
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().code, ErrorCode::Internal);
  EXPECT_EQ(store().job(job.id)->state, JobState::Running);
  EXPECT_TRUE(store().fits({}, {})->empty());
  EXPECT_TRUE(store().latest_channel_results(recording.device_id, "angular_rate", "z")->empty());
  EXPECT_EQ(store().result_document(job.id).error().code, ErrorCode::NotFound);
  EXPECT_EQ(store().events_after(job.id, 0, 100)->back().state, JobState::Running);
  EXPECT_TRUE(store().succeed(lease_of(job), results_for(job, recording))->held);
}

TEST_P(ResultStore, AResultOfARemovedRecordingIsRefusedWhole) {
  const Recording recording = add_recording(store(), add_device(store()));
  add_job(store(), "key");
  const Job job = claim_one(store());
  ASSERT_TRUE(store().remove_recording(recording.id, 1));  // the request does not name it
  EXPECT_FALSE(store().succeed(lease_of(job), results_for(job, recording)));
  EXPECT_EQ(store().job(job.id)->state, JobState::Running);
}

TEST_P(ResultStore, FitsAreFilteredByEveryMember) {
  const Device one = add_device(store(), "one");
  const Device two = add_device(store(), "two");
  const Recording first = add_recording(store(), one, "first");
  const Recording second = add_recording(store(), two, "second");
  const JobResults results = finish_job(store(), first, "gz");
  finish_job(store(), second, "gy");
  const auto count = [&](const FitFilter& filter) { return store().fits(filter, {})->size(); };
  EXPECT_EQ(count({}), 4U);
  FitFilter filter;
  filter.device_id = one.id;
  EXPECT_EQ(count(filter), 2U);
  filter.recording_id = first.id;
  filter.job_id = results.fits[0].job_id;
  filter.quantity = "angular_rate";
  filter.axis = "z";
  EXPECT_EQ(count(filter), 2U);
  filter.model = "WN";
  EXPECT_EQ(count(filter), 1U);
  filter.best_only = true;
  EXPECT_EQ(count(filter), 0U);
  filter.model = "WN+GM";
  EXPECT_EQ(count(filter), 1U);
  filter.best_only = false;
  EXPECT_EQ(count(filter), 1U);
  filter.recording_id = second.id;
  EXPECT_EQ(count(filter), 0U);
  FitFilter axis;
  axis.axis = "x";
  EXPECT_EQ(count(axis), 0U);
}

TEST_P(ResultStore, FitsComeInPages) {
  const Recording recording = add_recording(store(), add_device(store()));
  for (const char* channel : {"gx", "gy", "gz"}) {
    finish_job(store(), recording, channel);
  }
  std::vector<std::string> listed;
  Page page{"", 4};
  for (auto fits = store().fits({}, page); !fits->empty(); fits = store().fits({}, page)) {
    for (const Fit& fit : *fits) {
      listed.push_back(fit.id);
    }
    page.after = listed.back();
  }
  EXPECT_EQ(listed.size(), 6U);
  EXPECT_TRUE(std::is_sorted(listed.begin(), listed.end()));
}

TEST_P(ResultStore, OnlyTheLatestResultOfAChannelIsShownWhateverTheClockDid) {
  const Recording recording = add_recording(store(), add_device(store()));
  finish_job(store(), recording, "gz");
  clock_.advance(-kHour);
  const JobResults latest = finish_job(store(), recording, "gz");
  const auto channels = store().latest_channel_results(recording.device_id, "angular_rate", "z");
  ASSERT_EQ(channels->size(), 1U);
  EXPECT_EQ((*channels)[0].id, latest.channels[0].id);
  FitFilter filter;
  EXPECT_EQ(store().fits(filter, {})->size(), 4U);
  filter.latest_only = true;
  const auto fits = store().fits(filter, {});
  ASSERT_EQ(fits->size(), 2U);
  EXPECT_EQ((*fits)[0].channel_result_id, latest.channels[0].id);
  EXPECT_EQ((*fits)[1].channel_result_id, latest.channels[0].id);
}

TEST_P(ResultStore, ResultsOfAnEarlierRevisionAreNotTheLatest) {
  Recording recording = add_recording(store(), add_device(store()));
  finish_job(store(), recording);
  recording.metadata_json = R"({"rate_hz":1})";
  recording = *store().revise_recording(recording, 1);
  EXPECT_TRUE(store().latest_channel_results(recording.device_id, "angular_rate", "z")->empty());
  finish_job(store(), recording);
  EXPECT_EQ(store().latest_channel_results(recording.device_id, "angular_rate", "z")->size(), 1U);
}

TEST_P(ResultStore, AxesAreThoseThatALatestResultIsAbout) {
  const Device device = add_device(store());
  Recording recording = add_recording(store(), device);
  EXPECT_TRUE(store().axes_with_results(device.id, "angular_rate")->empty());
  for (const auto& [channel, axis] : {std::pair{"gz", "z"}, {"gx", "x"}, {"g", ""}}) {
    finish_job(store(), recording, channel, axis);
  }
  finish_job(store(), add_recording(store(), add_device(store(), "another"), "c"), "gy", "y");
  EXPECT_EQ(*store().axes_with_results(device.id, "angular_rate"), (std::vector<std::string>{"x", "z"}));
  EXPECT_TRUE(store().axes_with_results(device.id, "specific_force")->empty());
  recording.metadata_json = R"({"rate_hz":1})";
  ASSERT_TRUE(store().revise_recording(recording, 1));
  EXPECT_TRUE(store().axes_with_results(device.id, "angular_rate")->empty());
}

TEST_P(ResultStore, LatestResultsComeByConditionRecordingAndChannel) {
  const Device device = add_device(store());
  const Recording still = add_recording(store(), device, "a", "static");
  const Recording turning = add_recording(store(), device, "b", "rotation 10 deg/s");
  finish_job(store(), still, "g2");
  finish_job(store(), turning, "g1");
  finish_job(store(), still, "g1");
  finish_job(store(), add_recording(store(), add_device(store(), "another"), "c"), "g1");
  const auto channels = store().latest_channel_results(device.id, "angular_rate", "z");
  ASSERT_EQ(channels->size(), 3U);
  EXPECT_EQ((*channels)[0].recording_id, turning.id);
  EXPECT_EQ((*channels)[1].channel, "g1");
  EXPECT_EQ((*channels)[2].channel, "g2");
  EXPECT_TRUE(store().latest_channel_results(device.id, "angular_rate", "x")->empty());
  EXPECT_TRUE(store().latest_channel_results(device.id, "specific_force", "z")->empty());
}

TEST_P(ResultStore, ALargeDocumentComesBackWhole) {
  add_job(store(), "key");
  const Job job = claim_one(store());
  const std::string large(5'000'000, 'x');
  ASSERT_TRUE(store().succeed(lease_of(job), {large, {}, {}})->held);
  EXPECT_EQ(*store().result_document(job.id), large);
}

using ReplyStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(ReplyStore);

IdempotentReply reply_with(const std::string& key, const std::string& body) {
  IdempotentReply reply;
  reply.key = key;
  reply.method = "POST";
  reply.target = "/v1/jobs";
  reply.body_sha256 = hash_of(body);
  reply.status = 202;
  reply.headers_json = R"({"Location":"/v1/jobs/1"})";
  reply.body = body;
  return reply;
}

TEST_P(ReplyStore, AReplyIsKeptFor24Hours) {
  EXPECT_FALSE(store().idempotent_reply("key")->has_value());
  ASSERT_TRUE(store().remember_reply(reply_with("key", "first")));
  clock_.advance(24 * kHour - 1);
  const auto kept = store().idempotent_reply("key");
  ASSERT_TRUE(kept && *kept);
  EXPECT_EQ((*kept)->body, "first");
  EXPECT_EQ((*kept)->status, 202);
  EXPECT_EQ((*kept)->method, "POST");
  EXPECT_EQ((*kept)->target, "/v1/jobs");
  EXPECT_EQ((*kept)->body_sha256, hash_of("first"));
  EXPECT_EQ((*kept)->headers_json, R"({"Location":"/v1/jobs/1"})");
  EXPECT_EQ(*store().forget_old_replies(), 0);
  clock_.advance(1);
  EXPECT_FALSE(store().idempotent_reply("key")->has_value());
  EXPECT_EQ(*store().forget_old_replies(), 1);
}

TEST_P(ReplyStore, TheFirstReplyStaysAndAForgottenKeyMayBeUsedAgain) {
  ASSERT_TRUE(store().remember_reply(reply_with("key", "first")));
  ASSERT_TRUE(store().remember_reply(reply_with("key", "second")));
  EXPECT_EQ((*store().idempotent_reply("key"))->body, "first");
  clock_.advance(24 * kHour);
  ASSERT_TRUE(store().remember_reply(reply_with("key", "third")));
  EXPECT_EQ((*store().idempotent_reply("key"))->body, "third");
}

}  // namespace
}  // namespace driftlab::server
