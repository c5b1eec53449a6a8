#include "tests/unit/store/store_suite.hpp"

namespace driftlab::server {
namespace {

using StudyStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(StudyStore);

Study study_of(const Device& device, const std::string& key) {
  Study study;
  study.device_id = device.id;
  study.unique_key = key;
  study.document_json = R"({"recordings":[]})";
  return study;
}

TEST_P(StudyStore, TheSameStudyIsKeptOnce) {
  const Device device = add_device(store());
  const auto first = store().add_study(study_of(device, "a"));
  ASSERT_TRUE(first && first->created);
  EXPECT_TRUE(first->study.id.starts_with("stu_"));
  EXPECT_EQ(first->study.created_at, clock_.now());
  const auto again = store().add_study(study_of(device, "a"));
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->created);
  EXPECT_EQ(again->study.id, first->study.id);
  EXPECT_EQ(store().study(first->study.id)->document_json, R"({"recordings":[]})");
  EXPECT_EQ(store().study("stu_nobody").error().code, ErrorCode::NotFound);
}

TEST_P(StudyStore, StudiesAreListedByDevice) {
  const Device one = add_device(store(), "one");
  const Device two = add_device(store(), "two");
  for (const char* const key : {"a", "b", "c"}) {
    ASSERT_TRUE(store().add_study(study_of(key[0] == 'c' ? two : one, key)));
  }
  EXPECT_EQ(store().studies(std::nullopt, {})->size(), 3U);
  const auto page = store().studies(one.id, {"", 1});
  ASSERT_EQ(page->size(), 1U);
  EXPECT_EQ(store().studies(one.id, {page->front().id, 10})->size(), 1U);
  EXPECT_EQ(store().studies(two.id, {})->size(), 1U);
}

TEST_P(StudyStore, DrivesAreKeptOnceAndListedByDevice) {
  const Device one = add_device(store(), "one");
  const Device two = add_device(store(), "two");
  const auto add = [&](const Device& device, const std::string& key) {
    return store().add_drive({"", device.id, key, R"({"id":"town"})", 0});
  };
  const auto first = add(one, "a");
  ASSERT_TRUE(first && first->created);
  EXPECT_TRUE(first->drive.id.starts_with("drv_"));
  EXPECT_EQ(first->drive.created_at, clock_.now());
  EXPECT_FALSE(add(one, "a")->created);
  ASSERT_TRUE(add(two, "b")->created);
  EXPECT_EQ(store().drive(first->drive.id)->document_json, R"({"id":"town"})");
  EXPECT_EQ(store().drive("drv_nobody").error().code, ErrorCode::NotFound);
  EXPECT_EQ(store().drives(std::nullopt, {})->size(), 2U);
  EXPECT_EQ(store().drives(one.id, {})->size(), 1U);
}

TEST_P(StudyStore, CalibrationsAreKeptOnceAndListedByDevice) {
  const Device one = add_device(store(), "one");
  const Device two = add_device(store(), "two");
  const auto add = [&](const Device& device, const std::string& key) {
    return store().add_calibration({"", device.id, key, R"({"calibration":{}})", 0});
  };
  const auto first = add(one, "a");
  ASSERT_TRUE(first && first->created);
  EXPECT_TRUE(first->calibration.id.starts_with("cal_"));
  EXPECT_EQ(first->calibration.created_at, clock_.now());
  EXPECT_FALSE(add(one, "a")->created);
  ASSERT_TRUE(add(two, "b")->created);
  EXPECT_EQ(store().calibration(first->calibration.id)->document_json, R"({"calibration":{}})");
  EXPECT_EQ(store().calibration("cal_nobody").error().code, ErrorCode::NotFound);
  EXPECT_EQ(store().calibrations(std::nullopt, {})->size(), 2U);
  EXPECT_EQ(store().calibrations(two.id, {})->size(), 1U);
}

}  // namespace
}  // namespace driftlab::server
