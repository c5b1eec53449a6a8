#include "tests/unit/store/store_suite.hpp"

namespace driftlab::server {
namespace {

using DeviceStore = StoreSuite;
DRIFTLAB_OVER_ALL_STORES(DeviceStore);

TEST_P(DeviceStore, EnsuringANameTwiceGivesTheSameDevice) {
  Device wanted;
  wanted.name = "phone-07";
  wanted.model = "iPhone 5S";
  wanted.imu = "LSM330";
  wanted.serial = "A1";
  wanted.labels_json = R"({"lab":"north"})";
  const auto first = store().ensure_device(wanted);
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->created);
  EXPECT_TRUE(is_id(first->device.id, "dev"));
  EXPECT_EQ(first->device.revision, 1);
  EXPECT_EQ(first->device.created_at, clock_.now());

  wanted.model = "something else";
  const auto second = store().ensure_device(wanted);
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->created);
  EXPECT_EQ(second->device.id, first->device.id);
  EXPECT_EQ(second->device.model, "iPhone 5S");
  EXPECT_EQ(second->device.imu, "LSM330");
  EXPECT_EQ(second->device.serial, "A1");
  EXPECT_EQ(second->device.labels_json, R"({"lab":"north"})");
}

TEST_P(DeviceStore, IsFoundByIdAndByName) {
  const Device device = add_device(store(), "phone-07");
  EXPECT_EQ(store().device(device.id)->name, "phone-07");
  EXPECT_EQ(store().device("phone-07")->id, device.id);
  const auto absent = store().device("phone-08");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::NotFound);
}

TEST_P(DeviceStore, AnIdIsLookedUpBeforeAName) {
  const Device device = add_device(store(), "phone-07");
  add_device(store(), device.id);  // somebody calls a device by another one's id
  EXPECT_EQ(store().device(device.id)->name, "phone-07");
}

TEST_P(DeviceStore, NeedsAName) {
  const auto nameless = store().ensure_device({});
  ASSERT_FALSE(nameless);
  EXPECT_EQ(nameless.error().code, ErrorCode::InvalidArgument);
}

TEST_P(DeviceStore, KeepsEveryByteOfAText) {
  using namespace std::string_literals;
  const std::string name = "Bobby'); DROP TABLE devices;--\"\0\n\xF0\x9F\x93\xB1 %_?"s;
  const Device device = add_device(store(), name);
  EXPECT_EQ(store().device(device.id)->name, name);
  EXPECT_EQ(store().device(name)->id, device.id);
}

TEST_P(DeviceStore, PagesAscendWithoutOverlapAndWithoutGaps) {
  std::vector<std::string> ids;
  ids.reserve(7);
  for (int i = 0; i < 7; ++i) {
    ids.push_back(add_device(store(), "phone-" + std::to_string(i)).id);
  }
  std::sort(ids.begin(), ids.end());
  std::vector<std::string> listed;
  Page page;
  page.limit = 3;
  while (true) {
    const auto devices = store().devices({}, page);
    ASSERT_TRUE(devices);
    ASSERT_LE(devices->size(), 3U);
    if (devices->empty()) {
      break;
    }
    for (const Device& device : *devices) {
      listed.push_back(device.id);
    }
    page.after = listed.back();
  }
  EXPECT_EQ(listed, ids);
}

TEST_P(DeviceStore, AChangeTouchesOnlyWhatItNamesAndRaisesTheRevision) {
  Device wanted;
  wanted.name = "phone-07";
  wanted.model = "iPhone 5S";
  wanted.serial = "A1";
  const Device device = store().ensure_device(wanted)->device;
  clock_.advance(kSecond);
  DeviceChange change;
  change.serial = "B2";
  const auto changed = store().update_device(device.id, change, 1);
  ASSERT_TRUE(changed);
  EXPECT_EQ(changed->revision, 2);
  EXPECT_EQ(changed->serial, "B2");
  const auto read = store().device(device.id);
  EXPECT_EQ(read->model, "iPhone 5S");
  EXPECT_EQ(read->serial, "B2");
  EXPECT_EQ(read->revision, 2);
  EXPECT_EQ(read->updated_at, device.created_at + kSecond);
  EXPECT_EQ(read->created_at, device.created_at);
}

TEST_P(DeviceStore, AStaleChangeIsAConflictThatNamesTheRevision) {
  const Device device = add_device(store());
  DeviceChange change;
  change.model = "first";
  ASSERT_TRUE(store().update_device(device.id, change, 1));
  change.model = "second";
  const auto stale = store().update_device(device.id, change, 1);
  ASSERT_FALSE(stale);
  EXPECT_EQ(stale.error().code, ErrorCode::Conflict);
  EXPECT_THAT(stale.error().fields, testing::Contains(ErrorField{"revision", "2"}));
  EXPECT_EQ(store().device(device.id)->model, "first");
  const auto absent = store().update_device(make_id("dev", 0), change, 1);
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::NotFound);
}

TEST_P(DeviceStore, SurvivesReopening) {
  const Device device = add_device(store());
  reopen();
  EXPECT_EQ(store().device(device.id)->name, device.name);
}

TEST_P(DeviceStore, AnswersPing) { EXPECT_TRUE(store().ping()); }

}  // namespace
}  // namespace driftlab::server
