/// Nothing is removed from under what depends on it, and who depends is named.
#include "tests/unit/store/store_suite.hpp"

namespace driftlab::server {
namespace {

using RemovalStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(RemovalStore);

using testing::AllOf;
using testing::HasSubstr;

Study study_on(Store& store, const Device& device) {
  Study study;
  study.device_id = device.id;
  study.unique_key = device.id;
  study.document_json = "{}";
  return store.add_study(study)->study;
}

Model model_named(Store& store, const std::string& key, const std::string& device = "",
                  const std::string& parent = "") {
  Model model;
  model.unique_key = key;
  model.name = key;
  model.device_id = device;
  model.parent_id = parent;
  model.document_json = "{}";
  model.provenance_json = "{}";
  return store.add_model(model)->model;
}

/// The sentence of the refusal; empty where it was no conflict.
std::string conflict(const Status& removed) {
  return !removed && removed.error().code == ErrorCode::Conflict ? removed.error().message : "";
}

TEST_P(RemovalStore, ADeviceGoesAfterWhatItHas) {
  const Device device = add_device(store());
  const Study study = study_on(store(), device);
  const StoredDrive drive = store().add_drive({"", device.id, "drive", "{}", 0})->drive;
  const auto calibration = store().add_calibration({"", device.id, "key", "{}", 0})->calibration;
  const Model model = model_named(store(), "model", device.id);
  std::vector<Recording> recordings;
  for (int i = 0; i < 7; ++i) {
    clock_.advance(kSecond);  // ids are in the order of their time
    recordings.push_back(add_recording(store(), device, "bytes " + std::to_string(i)));
  }
  const Status refused = store().remove_device(device.id, device.revision);
  EXPECT_THAT(conflict(refused), AllOf(HasSubstr("7 recordings (" + recordings[0].id), HasSubstr(" and 2 more)"),
                                       HasSubstr("1 study (" + study.id + ")"), HasSubstr("1 drive (" + drive.id + ")"),
                                       HasSubstr(calibration.id), HasSubstr("1 model (" + model.id + ")")));
  ASSERT_EQ(refused.error().fields.size(), 5U);
  EXPECT_EQ(refused.error().fields[0].name, "recordings");
  EXPECT_THAT(conflict(store().remove_device(device.id, 7)), HasSubstr("changed by somebody else"));

  for (const Recording& recording : recordings) {
    ASSERT_TRUE(store().remove_recording(recording.id, recording.revision));
  }
  ASSERT_TRUE(store().remove_study(study.id));
  ASSERT_TRUE(store().remove_drive(drive.id));
  ASSERT_TRUE(store().remove_calibration(calibration.id));
  ASSERT_TRUE(store().remove_model(model.id));
  ASSERT_TRUE(store().remove_device(device.id, device.revision));
  for (const ErrorCode code :
       {store().device(device.id).error().code, store().study(study.id).error().code,
        store().drive(drive.id).error().code, store().remove_drive(drive.id).error().code,
        store().calibration(calibration.id).error().code, store().model(model.id).error().code,
        store().remove_device(device.id, 1).error().code, store().remove_study(study.id).error().code,
        store().remove_calibration(calibration.id).error().code, store().remove_model(model.id).error().code,
        store().remove_investigation("inv_nobody").error().code}) {
    EXPECT_EQ(code, ErrorCode::NotFound);
  }
  EXPECT_TRUE(store().ensure_device(device)->created) << "the name is free again";
}

TEST_P(RemovalStore, JobsThatHaveEndedGoWithTheirOnlyDevice) {
  const Device one = add_device(store(), "one");
  const Device two = add_device(store(), "two");
  const auto ask = [&](const std::string& key, const std::string& inputs) {
    return store().enqueue({"characterise", key, "{\"inputs\":[" + inputs + "]}", 5})->job;
  };
  const Job alone = ask("alone", '"' + one.id + '"');
  const Job shared = ask("shared", '"' + one.id + "\",\"" + two.id + '"');
  EXPECT_THAT(conflict(store().remove_device(one.id, 1)), AllOf(HasSubstr("2 running jobs"), HasSubstr(alone.id)));
  ASSERT_TRUE(store().request_cancel(alone.id));
  ASSERT_TRUE(store().request_cancel(shared.id));
  ASSERT_TRUE(store().remove_device(one.id, 1));
  EXPECT_EQ(store().job(alone.id).error().code, ErrorCode::NotFound);
  ASSERT_TRUE(store().job(shared.id)) << "it says something of the other device too";
  EXPECT_FALSE(*store().sees_job(shared.id, {R"(["two"])", "nobody"}))
      << "what it says of the device that is gone is not for tokens of the other";
}

TEST_P(RemovalStore, ACalibrationStaysWhileARecordingNamesIt) {
  const Device device = add_device(store());
  const auto calibration = store().add_calibration({"", device.id, "key", "{}", 0})->calibration;
  Recording recording = add_recording(store(), device);
  recording.metadata_json = R"({"calibration":")" + calibration.id + "\"}";
  recording = *store().revise_recording(recording, recording.revision);
  EXPECT_THAT(conflict(store().remove_calibration(calibration.id)), HasSubstr(recording.id));
  recording.metadata_json = "{}";
  ASSERT_TRUE(store().revise_recording(recording, recording.revision));
  const Job job = store().enqueue({"x", "key", "{\"calibration\":\"" + calibration.id + "\"}", 5})->job;
  EXPECT_THAT(conflict(store().remove_calibration(calibration.id)), HasSubstr(job.id));
  ASSERT_TRUE(store().request_cancel(job.id));
  EXPECT_TRUE(store().remove_calibration(calibration.id));
}

TEST_P(RemovalStore, AnInvestigationHoldsItsStudyAndItsModels) {
  const Device device = add_device(store());
  const Study study = study_on(store(), device);
  const Job job = add_job(store(), "investigate");
  const Job claimed = claim_one(store());
  const Model baseline = model_named(store(), "baseline", device.id);
  const Model child = model_named(store(), "child", device.id, baseline.id);
  JobResults results;
  results.document_json = "{}";
  Investigation made;
  made.id = "inv_01M7YQ3DCXWFAG31PB3STSGKWY";
  made.device_id = device.id;
  made.study_id = study.id;
  made.baseline_id = baseline.id;
  made.model_id = child.id;
  made.summary_json = "[]";
  results.investigations.push_back(made);
  ASSERT_TRUE(store().succeed(lease_of(claimed), results)->held);

  EXPECT_THAT(conflict(store().remove_study(study.id)), HasSubstr(made.id));
  EXPECT_THAT(conflict(store().remove_model(child.id)), HasSubstr(made.id));
  EXPECT_THAT(conflict(store().remove_model(baseline.id)), AllOf(HasSubstr(made.id), HasSubstr(child.id)));
  ASSERT_TRUE(store().remove_investigation(made.id));
  EXPECT_EQ(store().investigation(made.id).error().code, ErrorCode::NotFound);
  EXPECT_EQ(store().job(job.id).error().code, ErrorCode::NotFound) << "the same may be asked for again";
  EXPECT_TRUE(store().remove_study(study.id));
  EXPECT_THAT(conflict(store().remove_model(baseline.id)), HasSubstr(child.id));
  EXPECT_TRUE(store().remove_model(child.id));
  EXPECT_TRUE(store().remove_model(baseline.id));
}

}  // namespace
}  // namespace driftlab::server
