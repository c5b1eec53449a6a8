#include "core/signal/column_streams.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// What each column measures, as text: `angular_rate:x`, `time`, or empty.
std::vector<std::string> roles_of(const std::string& stream, const ColumnNames& names) {
  RecordingSpec spec;
  spec.stream = stream;
  const auto roles = assign_roles(spec, names);
  std::vector<std::string> texts;
  if (!roles) {
    return {roles.error().message};
  }
  for (const auto& role : *roles) {
    texts.push_back(!role                ? ""
                    : role->axis.empty() ? std::string(name_of(role->quantity))
                                         : std::string(name_of(role->quantity)) + ":" + role->axis);
  }
  return texts;
}

TEST(ColumnStreams, ReadAUnitByWhatStandsBehindItsName) {
  const ColumnNames names{"time (s)", "front_gx (deg/s)", "front_gy (deg/s)", "rear_gx (deg/s)", "rear.az (g)"};
  EXPECT_THAT(roles_of("rear", names), ElementsAre("time", "", "", "angular_rate:x", "specific_force:z"));
  EXPECT_THAT(roles_of("front", names), ElementsAre("time", "angular_rate:x", "angular_rate:y", "", ""));
}

TEST(ColumnStreams, AUnitWithATimeOfItsOwnIsReadByIt) {
  const ColumnNames names{"time (s)", "gyro_x (rad/s)", "imu2_time (s)", "imu2_gyro_x (rad/s)"};
  EXPECT_THAT(roles_of("", names), ElementsAre("time", "angular_rate:x", "", ""));
  EXPECT_THAT(roles_of("imu2", names), ElementsAre("", "", "time", "angular_rate:x"));
}

TEST(ColumnStreams, TwoStructsOfOneFileAreTwoUnits) {
  ColumnNames names;
  for (const char* const unit : {"imu1", "imu2"}) {
    for (const char* const member : {"t", "wb_x", "wb_y", "wb_z", "fb_x", "fb_y", "fb_z"}) {
      names.push_back(std::string(unit) + "." + member);
    }
  }
  EXPECT_THAT(roles_of("imu2", names),
              ElementsAre("", "", "", "", "", "", "", "time", "angular_rate:x", "angular_rate:y", "angular_rate:z",
                          "specific_force:x", "specific_force:y", "specific_force:z"));
}

TEST(ColumnStreams, RefuseAStreamThatIsNotThereOrBesideColumns) {
  RecordingSpec spec;
  spec.stream = "imu7";
  const ColumnNames names{"time (s)", "imu2_gyro_x (rad/s)", "imu"};
  const auto unknown = assign_roles(spec, names);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().code, ErrorCode::UnknownColumn);
  EXPECT_THAT(unknown.error().message, HasSubstr("'imu7'"));
  spec.stream = "imu2";
  spec.columns["imu"] = {Quantity::AngularRate, "x", std::nullopt};
  const auto both = assign_roles(spec, names);
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().code, ErrorCode::InvalidArgument);
  spec.columns = {{"time (s)", {Quantity::Time, "", *parse_unit("s")}}};
  EXPECT_TRUE(assign_roles(spec, names)) << "a time may be stated beside it";
}

TEST(ColumnStreams, ANameBelongsToAStreamOnlyBehindAMark) {
  EXPECT_EQ(name_within("imu2", "imu2_gx"), "gx");
  EXPECT_EQ(name_within("imu2", "imu2/gx"), "gx");
  EXPECT_FALSE(name_within("imu2", "imu22_gx"));
  EXPECT_FALSE(name_within("imu2", "imu2_"));
  EXPECT_FALSE(name_within("", "_gx"));
}

}  // namespace
}  // namespace driftlab
