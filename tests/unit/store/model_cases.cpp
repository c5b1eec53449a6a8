#include "tests/unit/store/store_suite.hpp"

namespace driftlab::server {
namespace {

using testing::SizeIs;

using ModelStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(ModelStore);

Model model_of(const std::string& key, const std::string& parent = "", const std::string& device = "") {
  Model model;
  model.parent_id = parent;
  model.device_id = device;
  model.unique_key = key;
  model.name = "model " + key;
  model.document_json = R"({"processes":[]})";
  model.provenance_json = R"({"made_by":"hand"})";
  return model;
}

/// An investigation of `device` by a finished job: a baseline, a child, a report.
JobResults investigation_of(const Device& device, const Study& study) {
  JobResults results;
  results.document_json = R"({"findings":[]})";
  Model baseline = model_of("baseline " + study.id, "", device.id);
  baseline.id = make_id("mod", 1);
  Model extended = model_of("extended " + study.id, baseline.id, device.id);
  extended.id = make_id("mod", 2);
  Investigation made;
  made.device_id = device.id;
  made.study_id = study.id;
  made.baseline_id = baseline.id;
  made.model_id = extended.id;
  made.summary_json = "[]";
  made.page = "# page";
  results.models = {std::move(baseline), std::move(extended)};
  results.investigations.push_back(std::move(made));
  return results;
}

Study add_study(Store& store, const Device& device) {
  Study study;
  study.device_id = device.id;
  study.unique_key = "study of " + device.name;
  study.document_json = "{}";
  return store.add_study(study)->study;
}

TEST_P(ModelStore, TheSameModelIsKeptOnce) {
  const auto first = store().add_model(model_of("a"));
  ASSERT_TRUE(first && first->created);
  EXPECT_TRUE(first->model.id.starts_with("mod_"));
  const auto again = store().add_model(model_of("a"));
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->created);
  EXPECT_EQ(again->model.id, first->model.id);
  const auto read = store().model(first->model.id);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->name, "model a");
  EXPECT_EQ(read->parent_id, "");
  EXPECT_EQ(read->device_id, "");
  EXPECT_EQ(read->provenance_json, R"({"made_by":"hand"})");
  EXPECT_EQ(read->created_at, clock_.now());
  EXPECT_EQ(store().model("mod_nobody").error().code, ErrorCode::NotFound);
}

TEST_P(ModelStore, RevisionsAreListedByParentAndDevice) {
  const Device device = add_device(store());
  const std::string root = store().add_model(model_of("root", "", device.id))->model.id;
  for (const char* const key : {"one", "two"}) {
    ASSERT_TRUE(store().add_model(model_of(key, root)));
  }
  EXPECT_THAT(*store().models({}, {}), SizeIs(3));
  EXPECT_THAT(*store().models({device.id, {}}, {}), SizeIs(1));
  const auto page = store().models({{}, root}, {"", 1});
  ASSERT_THAT(*page, SizeIs(1));
  EXPECT_THAT(*store().models({{}, root}, {page->front().id, 10}), SizeIs(1));
  EXPECT_EQ(store().add_model(model_of("orphan", "mod_nobody")).error().code, ErrorCode::NotFound);
}

TEST_P(ModelStore, AFinishWritesInvestigationAndModelsTogether) {
  const Device device = add_device(store());
  const Study study = add_study(store(), device);
  add_job(store(), "key");
  const Job job = claim_one(store());
  const JobResults results = investigation_of(device, study);
  ASSERT_TRUE(store().succeed(lease_of(job), results)->held);
  const auto listed = store().investigations({device.id, study.id, job.id}, {});
  ASSERT_TRUE(listed);
  ASSERT_THAT(*listed, SizeIs(1));
  const auto read = store().investigation(listed->front().id);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->page, "# page");
  EXPECT_EQ(read->job_id, job.id);
  EXPECT_EQ(store().model(read->model_id)->parent_id, read->baseline_id);
  EXPECT_THAT(*store().investigations({"dev_other", {}, {}}, {}), SizeIs(0));
  EXPECT_EQ(store().investigation("inv_nobody").error().code, ErrorCode::NotFound);
}

TEST_P(ModelStore, AChildWithoutItsParentUndoesTheWholeFinish) {
  const Device device = add_device(store());
  const Study study = add_study(store(), device);
  add_job(store(), "key");
  const Job job = claim_one(store());
  JobResults results = investigation_of(device, study);
  results.models.erase(results.models.begin());
  EXPECT_FALSE(store().succeed(lease_of(job), results));
  EXPECT_EQ(store().job(job.id)->state, JobState::Running);
  EXPECT_THAT(*store().models({}, {}), SizeIs(0));
}

TEST_P(ModelStore, ARemovedRecordingTakesItsInvestigationsAlongAndLeavesTheModels) {
  const Device device = add_device(store());
  const Study study = add_study(store(), device);
  const Recording recording = add_recording(store(), device);
  NewJob asked;
  asked.kind = "investigate";
  asked.unique_key = "key";
  asked.request_json = R"({"inputs":{"recordings":[{"id":")" + recording.id + R"("}]}})";
  ASSERT_TRUE(store().enqueue(asked));
  const Job job = claim_one(store());
  ASSERT_TRUE(store().succeed(lease_of(job), investigation_of(device, study))->held);
  ASSERT_TRUE(store().remove_recording(recording.id, 1));
  EXPECT_THAT(*store().investigations({}, {}), SizeIs(0));
  EXPECT_THAT(*store().models({}, {}), SizeIs(2));
}

}  // namespace
}  // namespace driftlab::server
