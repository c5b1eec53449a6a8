#include "tests/unit/store/store_suite.hpp"

namespace driftlab::server {
namespace {

using RecordingStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(RecordingStore);

Blob blob_named(const std::string& seed) {
  Blob blob;
  blob.sha256 = hash_of(seed);
  blob.bytes = 12;
  blob.format = "npy";
  blob.compression = "xz";
  blob.rows = 3;
  blob.columns_json = R"(["gx"])";
  blob.notes_json = R"(["a note"])";
  return blob;
}

Recording recording_of(const Device& device, const std::string& metadata = "{}") {
  Recording recording;
  recording.device_id = device.id;
  recording.metadata_json = metadata;
  recording.condition = "static";
  return recording;
}

TEST_P(RecordingStore, AddsBlobAndRecordingTogether) {
  const Device device = add_device(store());
  const auto added = store().add_recording(blob_named("a"), recording_of(device, R"({"rate_hz":100})"));
  ASSERT_TRUE(added);
  EXPECT_TRUE(added->created);
  EXPECT_TRUE(is_id(added->recording.id, "rec"));
  const auto blob = store().blob(hash_of("a"));
  ASSERT_TRUE(blob && *blob);
  EXPECT_EQ((*blob)->format, "npy");
  EXPECT_EQ((*blob)->compression, "xz");
  EXPECT_EQ((*blob)->rows, 3);
  EXPECT_EQ((*blob)->columns_json, R"(["gx"])");
  EXPECT_EQ((*blob)->notes_json, R"(["a note"])");
  const auto read = store().recording(added->recording.id);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->blob_sha256, hash_of("a"));
  EXPECT_EQ(read->metadata_json, R"({"rate_hz":100})");
  EXPECT_EQ(read->revision, 1);
}

TEST_P(RecordingStore, TheSameBytesAndMetadataAreTheSameRecording) {
  const Device device = add_device(store());
  const auto first = store().add_recording(blob_named("a"), recording_of(device));
  const auto second = store().add_recording(blob_named("a"), recording_of(device));
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(second->created);
  EXPECT_EQ(second->recording.id, first->recording.id);
  EXPECT_EQ(store().recordings({}, {})->size(), 1U);
}

TEST_P(RecordingStore, OtherMetadataForTheSameBytesConflictsAndNamesTheRecording) {
  const Device device = add_device(store());
  const auto first = store().add_recording(blob_named("a"), recording_of(device));
  const auto second = store().add_recording(blob_named("a"), recording_of(device, R"({"rate_hz":50})"));
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().code, ErrorCode::Conflict);
  EXPECT_THAT(second.error().fields, testing::Contains(ErrorField{"recording_id", first->recording.id}));
  EXPECT_EQ(store().recording(first->recording.id)->metadata_json, "{}");
}

TEST_P(RecordingStore, AnUnknownDeviceLeavesNoBlobBehind) {
  Device absent;
  absent.id = make_id("dev", 0);
  const auto added = store().add_recording(blob_named("a"), recording_of(absent));
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::NotFound);
  EXPECT_TRUE(store().blob_hashes()->empty());
}

TEST_P(RecordingStore, AFaultyBlobLeavesNeitherRowBehind) {
  const Device device = add_device(store());
  Blob blob = blob_named("a");
  blob.sha256 = "../../etc/passwd";
  EXPECT_FALSE(store().add_recording(blob, recording_of(device)));
  EXPECT_TRUE(store().blob_hashes()->empty());
  EXPECT_TRUE(store().recordings({}, {})->empty());
}

TEST_P(RecordingStore, TwoDevicesShareOneBlob) {
  add_recording(store(), add_device(store(), "one"), "a");
  add_recording(store(), add_device(store(), "two"), "a");
  EXPECT_EQ(store().recordings({}, {})->size(), 2U);
  EXPECT_THAT(*store().blob_hashes(), testing::ElementsAre(hash_of("a")));
}

TEST_P(RecordingStore, ListsByDeviceAndConditionInPages) {
  const Device one = add_device(store(), "one");
  const Device two = add_device(store(), "two");
  std::vector<std::string> still;
  still.reserve(5);
  for (int i = 0; i < 5; ++i) {
    still.push_back(add_recording(store(), one, "still" + std::to_string(i)).id);
  }
  add_recording(store(), one, "moving", "rotation 10 deg/s");
  add_recording(store(), two, "other");
  std::sort(still.begin(), still.end());
  RecordingFilter filter;
  filter.device_id = one.id;
  filter.condition = "static";
  std::vector<std::string> listed;
  Page page{"", 2};
  for (auto rows = store().recordings(filter, page); !rows->empty(); rows = store().recordings(filter, page)) {
    for (const Recording& row : *rows) {
      listed.push_back(row.id);
    }
    page.after = listed.back();
  }
  EXPECT_EQ(listed, still);
  filter.condition.reset();
  EXPECT_EQ(store().recordings(filter, {})->size(), 6U);
  EXPECT_EQ(store().recordings({}, {})->size(), 7U);
}

TEST_P(RecordingStore, ThoseOfSomeIdsAreReadAtOnce) {
  const Device device = add_device(store());
  std::vector<std::string> ids;
  for (const char* name : {"a", "b", "c"}) {
    ids.push_back(store().add_recording(blob_named(name), recording_of(device))->recording.id);
  }
  auto read = store().recordings_of({ids[2], "rec_00000000000000000000000000", ids[0], ids[2], "'; --"});
  ASSERT_TRUE(read);
  std::ranges::sort(*read, {}, &Recording::id);
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ(read->front().id, ids[0]);
  EXPECT_EQ(read->back().id, ids[2]);
  EXPECT_EQ(read->back().blob_sha256, hash_of("c"));
  EXPECT_TRUE(store().recordings_of({})->empty());
}

TEST_P(RecordingStore, ARevisionReplacesTheMeaningAndKeepsTheBytes) {
  Recording recording = add_recording(store(), add_device(store()));
  clock_.advance(kSecond);
  recording.metadata_json = R"({"rate_hz":200})";
  recording.condition = "rotation 10 deg/s";
  recording.quality_json = R"({"gaps":1})";
  recording.blob_sha256 = hash_of("something else");
  const auto revised = store().revise_recording(recording, 1);
  ASSERT_TRUE(revised);
  EXPECT_EQ(revised->revision, 2);
  const auto read = store().recording(recording.id);
  EXPECT_EQ(read->metadata_json, R"({"rate_hz":200})");
  EXPECT_EQ(read->condition, "rotation 10 deg/s");
  EXPECT_EQ(read->quality_json, R"({"gaps":1})");
  EXPECT_EQ(read->blob_sha256, hash_of("bytes"));
  EXPECT_EQ(read->updated_at, clock_.now());

  const auto stale = store().revise_recording(recording, 1);
  ASSERT_FALSE(stale);
  EXPECT_EQ(stale.error().code, ErrorCode::Conflict);
  EXPECT_THAT(stale.error().fields, testing::Contains(ErrorField{"revision", "2"}));
  recording.id = make_id("rec", 0);
  EXPECT_EQ(store().revise_recording(recording, 1).error().code, ErrorCode::NotFound);
}

TEST_P(RecordingStore, RemovingTakesTheResultsAlong) {
  const Recording recording = add_recording(store(), add_device(store()));
  add_job(store(), "key");
  const Job job = claim_one(store());
  const JobResults results = results_for(job, recording);
  ASSERT_TRUE(store().succeed(lease_of(job), results)->held);
  ASSERT_EQ(store().fits({}, {})->size(), 2U);

  EXPECT_EQ(store().remove_recording(recording.id, 2).error().code, ErrorCode::Conflict);
  ASSERT_TRUE(store().remove_recording(recording.id, 1));
  EXPECT_EQ(store().recording(recording.id).error().code, ErrorCode::NotFound);
  EXPECT_EQ(store().fit(results.fits[0].id).error().code, ErrorCode::NotFound);
  EXPECT_TRUE(store().fits({}, {})->empty());
  EXPECT_TRUE(store().latest_channel_results(recording.device_id, "angular_rate", "z")->empty());
  EXPECT_EQ(store().result_document(job.id).error().code, ErrorCode::NotFound);
  EXPECT_EQ(store().remove_recording(recording.id, 1).error().code, ErrorCode::NotFound);
}

TEST_P(RecordingStore, IsNotRemovedWhileAJobNeedsIt) {
  const Recording recording = add_recording(store(), add_device(store()));
  ASSERT_TRUE(store().enqueue({"characterise", "key", R"({"inputs":{"recording":")" + recording.id + R"("}})"}));
  const auto queued = store().remove_recording(recording.id, 1);
  ASSERT_FALSE(queued);
  EXPECT_EQ(queued.error().code, ErrorCode::Conflict);
  const Job job = claim_one(store());
  EXPECT_EQ(store().remove_recording(recording.id, 1).error().code, ErrorCode::Conflict);
  ASSERT_TRUE(store().fail_attempt(lease_of(job), {"{}"}));
  EXPECT_TRUE(store().remove_recording(recording.id, 1));
}

TEST_P(RecordingStore, ABlobRowGoesOnlyWhenNobodyNamesIt) {
  const Recording recording = add_recording(store(), add_device(store()), "a");
  EXPECT_FALSE(*store().remove_unused_blob(hash_of("a")));
  ASSERT_TRUE(store().remove_recording(recording.id, 1));
  EXPECT_TRUE(*store().remove_unused_blob(hash_of("a")));
  EXPECT_FALSE(*store().remove_unused_blob(hash_of("a")));
  EXPECT_FALSE(store().blob(hash_of("a"))->has_value());
}

TEST_P(RecordingStore, TagsChangeWithoutARevision) {
  const Device device = add_device(store());
  const Recording first = add_recording(store(), device, "one");
  const Recording other = add_recording(store(), device, "two");
  Recording tagged = first;
  tagged.tags_json = R"({"labels":{"board":"b","firmware":"1.5.0"}})";
  const auto changed = store().revise_recording(tagged, first.revision);
  ASSERT_TRUE(changed);
  EXPECT_EQ(changed->revision, first.revision) << "results name the revision, and stay";
  EXPECT_EQ(changed->tags_revision, 1);
  EXPECT_EQ(store().revise_recording(tagged, first.revision).error().code, ErrorCode::Conflict) << "as it was read";
  const auto having = [&](std::vector<std::string> labels) {
    RecordingFilter filter;
    filter.labels = std::move(labels);
    std::vector<std::string> ids;
    const auto found = store().recordings(filter, {});
    for (const Recording& recording : found ? *found : std::vector<Recording>{}) {
      ids.push_back(recording.id);
    }
    return ids;
  };
  EXPECT_EQ(having({"firmware=1.5.0"}), std::vector{first.id});
  EXPECT_EQ(having({"firmware=1.5.0", "board=b"}), std::vector{first.id});
  EXPECT_EQ(having({"firmware=1.5"}), std::vector<std::string>{});
  EXPECT_EQ(having({"firmware=1.5.0", "board=c"}), std::vector<std::string>{});
  Recording both = *changed;
  both.tags_json = "{}";
  both.metadata_json = R"({"trim":{}})";
  const auto revised = store().revise_recording(both, changed->revision);
  ASSERT_TRUE(revised);
  EXPECT_EQ(revised->revision, first.revision + 1);
  EXPECT_EQ(revised->tags_revision, 2);
  EXPECT_EQ(having({}).size(), 2U);
}

TEST_P(RecordingStore, AnchorsAreAHistoryAndGoWithTheirDevice) {
  const Device device = add_device(store());
  for (const char* const label : {"firmware=1.0", "firmware=1.1"}) {
    clock_.advance(kSecond);
    ASSERT_TRUE(store().add_anchor({"", device.id, label, "why", 0, R"({"alpha":0.05})"}));
  }
  const auto all = store().anchors(device.id, {});
  ASSERT_EQ(all->size(), 2U);
  EXPECT_TRUE(all->front().id.starts_with("anc_"));
  EXPECT_EQ(all->front().settings_json, R"({"alpha":0.05})");
  EXPECT_EQ(store().anchors(device.id, {.after = "", .limit = 1, .order = PageOrder::NewestFirst})->front().label,
            "firmware=1.1");
  ASSERT_TRUE(store().remove_device(device.id, device.revision));
  EXPECT_TRUE(store().anchors(std::nullopt, {})->empty());
}

}  // namespace
}  // namespace driftlab::server
