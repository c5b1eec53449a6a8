#include "tests/unit/read/ros_samples.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <bit>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kImu = "sensor_msgs/msg/Imu";

/// The column, exactly.
std::vector<double> column(const Outcome& outcome, std::size_t index) {
  std::vector<double> values;
  for (const std::uint64_t bits : outcome.bits.at(index)) {
    values.push_back(std::bit_cast<double>(bits));
  }
  return values;
}

TEST(SameData, ReadTheSameInEveryFormatOfFlightAndRobotLogs) {
  const std::vector<InertialRow> rows = inertial_rows(50);
  const Outcome first = decode_bytes(ulog(rows));
  ASSERT_FALSE(first.error) << first.message;
  const std::vector<std::string> files{
      mcap(rows),   mcap(rows, "zstd"),  mcap(rows, "lz4"),  mcap(rows, "", "ros1"), mcap(rows, "lz4", "ros1"),
      rosbag(rows), rosbag(rows, "bz2"), rosbag(rows, "lz4")};
  for (const std::string& file : files) {
    const Outcome other = decode_bytes(file);
    ASSERT_FALSE(other.error) << other.message;
    EXPECT_EQ(other.decoded.names, first.decoded.names);
    EXPECT_EQ(other.bits, first.bits);
    EXPECT_THAT(other.decoded.notes, IsEmpty());
  }
}

TEST(RosImu, ReadsBothByteOrdersAndAnyPaddingOfCdr) {
  const InertialRow row = inertial_rows(2)[1];
  for (const std::string frame : {"", "a", "abcdef", "abcdefg", "abcdefgh"}) {
    const Outcome outcome =
        decode_bytes(mcap_file("", mcap_channel(0, "/imu", kImu, "cdr") + mcap_message(0, 1, cdr_imu(row, frame)) +
                                       mcap_message(0, 1, cdr_imu(row, frame))));
    ASSERT_FALSE(outcome.error) << outcome.message;
    EXPECT_EQ(column(outcome, 1)[0], row.gyro_rad_s[0]) << frame;
    EXPECT_EQ(column(outcome, 6)[0], row.accel_m_s2[2]) << frame;
  }
  const auto reversed = [](std::string bytes, std::size_t at, std::size_t size) {
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + size));
    return bytes;
  };
  std::string big = cdr_imu(row, "abc");
  big[1] = '\0';
  for (const std::size_t at : {4, 8, 12}) {
    big = reversed(big, at, 4);
  }
  for (std::size_t at = 20; at < big.size(); at += 8) {
    big = reversed(big, at, 8);
  }
  const Outcome outcome = decode_bytes(mcap_file("", mcap_channel(0, "/imu", kImu, "cdr") + mcap_message(0, 1, big)));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(column(outcome, 1)[0], row.gyro_rad_s[0]);
}

TEST(RosImu, LeavesOutASensorWhoseCovarianceSaysItIsNotThere) {
  const InertialRow row = inertial_rows(2)[1];
  const std::string records =
      bag_connection(0, "/accel", "sensor_msgs/Imu") + bag_message(0, 1, ros1_imu(row, imu_numbers(row, -1.0, 0.0)));
  const Outcome outcome = decode_bytes(bag_front() + records);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("time (s)", "acc_x (m/s^2)", "acc_y (m/s^2)", "acc_z (m/s^2)"));
}

TEST(RosImu, TakesTheTimeOfRecordingWhereMessagesHaveNoStamp) {
  std::vector<InertialRow> rows = inertial_rows(3);
  std::string records = mcap_channel(0, "/imu", kImu, "cdr");
  for (InertialRow row : rows) {
    const std::uint64_t recorded = row.time_us;
    row.time_us = 0;
    records += mcap_message(0, recorded, cdr_imu(row));
  }
  const Outcome outcome = decode_bytes(mcap_file("", records));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(column(outcome, 0), ElementsAre(0.0, 0.005, 0.01));
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("'/imu' have no stamp")));
}

TEST(RosImu, NamesTheTopicsItLeavesOutAndThoseOfAFileWithoutAny) {
  const InertialRow row = inertial_rows()[0];
  const std::string other = bag_connection(4, "/pose\n", "geometry_msgs/PoseStamped") + bag_message(4, 1, "12345678");
  const Outcome with = decode_bytes(bag_front() + other + bag_connection(0, "/imu", "sensor_msgs/Imu") +
                                    bag_message(0, 1, ros1_imu(row)) + bag_message(0, 1, "torn message"));
  ASSERT_FALSE(with.error) << with.message;
  EXPECT_THAT(with.decoded.notes,
              ElementsAre(HasSubstr("1 message cannot be read"), HasSubstr("'/pose?' ('geometry_msgs/PoseStamped')")));
  const Outcome without = decode_bytes(bag_front() + other);
  EXPECT_EQ(without.error, ErrorCode::NoSamples);
  EXPECT_THAT(without.message, HasSubstr("its topics are '/pose?' ('geometry_msgs/PoseStamped')"));
}

TEST(Rosbag, ReadsWhatIsBeforeATornTailAndSaysSo) {
  for (const std::string compression : {"none", "bz2", "lz4"}) {
    const std::string whole = rosbag(inertial_rows(), compression);
    const std::string file = bag_front(0) + whole.substr(bag_front().size());  // as rosbag leaves it when it is killed
    const std::size_t behind =
        file.size() - bag_record({"op=\x04"}, "index").size() - bag_connection(0, "/imu", "sensor_msgs/Imu").size();
    const Outcome closed = decode_bytes(std::string_view(file).substr(0, behind));
    ASSERT_FALSE(closed.error) << closed.message;
    EXPECT_EQ(closed.decoded.rows, 4U);
    EXPECT_THAT(closed.decoded.notes, ElementsAre(HasSubstr("The bag was not closed")));
  }
  const std::string plain = rosbag(inertial_rows());
  const Outcome torn = decode_bytes(std::string_view(plain).substr(0, plain.size() - 400));
  ASSERT_FALSE(torn.error) << torn.message;
  EXPECT_EQ(torn.decoded.rows, 3U);
  EXPECT_THAT(torn.decoded.notes, ElementsAre(HasSubstr("within a record")));
}

TEST(Rosbag, RefusesWhatItCannotReadAndSaysWhere) {
  const std::string chunk = bag_chunk("bz2", rosbag(inertial_rows()));
  std::string damaged = chunk;
  damaged[damaged.size() - 60] = static_cast<char>(damaged[damaged.size() - 60] ^ 0x5A);
  const std::string where = "at byte " + std::to_string(bag_front().size());
  const std::vector<std::tuple<std::string, ErrorCode, std::string>> cases{
      {"#ROSBAG V1.2\n", ErrorCode::UnsupportedType, "another version"},
      {"#ROSBAG V2.0\nE\1", ErrorCode::Truncated, "ends within a record"},
      {bag_front() + "\xff\xff\xff\x7f....", ErrorCode::ShapeMismatch, where},
      {bag_front() + bag_record({"conn=...."}, ""), ErrorCode::ShapeMismatch, "what it is"},
      {bag_front() + bag_chunk("brotli", "..."), ErrorCode::UnsupportedType, "'brotli'"},
      {bag_front() + damaged, ErrorCode::CorruptCompression, "The chunk at byte"},
      {bag_front() + bag_record({"op=\5", "compression=lz4"}, "no frame"), ErrorCode::CorruptCompression, "decompress"},
      {bag_front() + bag_chunk("none", bag_message(0, 1, "x").substr(0, 30)), ErrorCode::ShapeMismatch, "ends within"},
  };
  for (const auto& [bytes, code, says] : cases) {
    const Outcome outcome = decode_bytes(bytes);
    EXPECT_EQ(outcome.error, code) << outcome.message;
    EXPECT_THAT(outcome.message, HasSubstr(says));
  }
}

TEST(Rosbag, CountsEveryChunkAgainstOneBudget) {
  DecodeLimits limits;
  limits.expansion_allowance = 1 << 20;
  limits.expansion_ratio = 0;
  const std::string chunk = bag_chunk("bz2", bag_message(9, 1, std::string(600'000, '\0')));
  EXPECT_EQ(decode_bytes(bag_front() + chunk, 4096, limits).error, ErrorCode::NoSamples);
  EXPECT_EQ(decode_bytes(bag_front() + chunk + chunk, 4096, limits).error, ErrorCode::DecompressionLimit);
}

TEST(Mcap, VerifiesTheChecksumOfAChunk) {
  const std::string records = mcap_channel(0, "/imu", kImu, "cdr") + mcap_message(0, 1, cdr_imu(inertial_rows()[0]));
  for (const std::string compression : {"", "lz4", "zstd"}) {
    EXPECT_FALSE(decode_bytes(kMcapMagic + mcap_chunk(compression, records, 0)).error) << "0 states no checksum";
    const Outcome wrong = decode_bytes(kMcapMagic + mcap_chunk(compression, records, crc_of(records) ^ 1U));
    EXPECT_EQ(wrong.error, ErrorCode::CorruptCompression);
    EXPECT_THAT(wrong.message, HasSubstr("is damaged: its checksum is wrong.")) << compression;
  }
}

TEST(Mcap, ReadsWhatIsBeforeATornTailAndSaysSo) {
  const std::string whole = mcap(inertial_rows());
  const Outcome torn = decode_bytes(std::string_view(whole).substr(0, whole.size() - 200));
  ASSERT_FALSE(torn.error) << torn.message;
  EXPECT_EQ(torn.decoded.rows, 3U);
  EXPECT_THAT(torn.decoded.notes, ElementsAre(HasSubstr("The file was not closed")));
}

TEST(Mcap, RefusesWhatItCannotReadAndSaysWhere) {
  const std::vector<std::tuple<std::string, ErrorCode, std::string>> cases{
      {kMcapMagic, ErrorCode::Truncated, "at byte 8"},
      {kMcapMagic + mcap_record(5, "short"), ErrorCode::ShapeMismatch, "byte 8"},
      {kMcapMagic + mcap_record(3, "x"), ErrorCode::ShapeMismatch, "a schema"},
      {kMcapMagic + mcap_record(4, "x"), ErrorCode::ShapeMismatch, "a channel"},
      {kMcapMagic + mcap_record(6, std::string(60, '\1')), ErrorCode::ShapeMismatch, "lengths"},
      {mcap_file("br", ""), ErrorCode::UnsupportedType, "'br'"},
      {mcap_file("", mcap_channel(0, "/imu", kImu, "json")), ErrorCode::NoSamples, "'/imu'"},
  };
  for (const auto& [bytes, code, says] : cases) {
    const Outcome outcome = decode_bytes(bytes);
    EXPECT_EQ(outcome.error, code) << outcome.message;
    EXPECT_THAT(outcome.message, HasSubstr(says));
  }
}

}  // namespace
}  // namespace driftlab
