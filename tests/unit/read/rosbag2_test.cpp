#include "tests/unit/read/ros_samples.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Rosbag2, ReadsTheSameFromAFileFromMemoryAndAsMcap) {
  const TemporaryDirectory directory;
  const std::vector<InertialRow> rows = inertial_rows(40);
  const std::string bag = rosbag2(rows);
  const Outcome memory = decode_bytes(bag);
  ASSERT_FALSE(memory.error) << memory.message;
  EXPECT_EQ(memory.bits, decode_bytes(mcap(rows)).bits);
  EXPECT_THAT(memory.decoded.notes, ElementsAre(HasSubstr("'/log' ('rcl_interfaces/msg/Log')")));

  // The name has signs that mean something in the address of a database.
  write_file(directory / "a?b%20#.db3", bag);
  KeepingSink sink;
  auto reader = open_file_reader(directory / "a?b%20#.db3");
  ASSERT_TRUE(reader);
  const auto decoded = decode_stream(std::move(*reader), sink);
  ASSERT_TRUE(decoded) << decoded.error().message;
  ASSERT_EQ(sink.columns.size(), memory.bits.size());
  for (std::size_t c = 0; c < sink.columns.size(); ++c) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_EQ(std::bit_cast<std::uint64_t>(sink.columns[c][i]), memory.bits[c][i]);
    }
  }
  EXPECT_THAT(directory.entries(), ElementsAre("a?b%20#.db3")) << "reading leaves no journal";
}

TEST(Rosbag2, ReadsABagWhoseLogLiesBesideItAsFarAsItGoes) {
  // rosbag2 leaves databases in the mode of a write-ahead log; from memory such a database opens only without.
  std::string bag = rosbag2(inertial_rows());
  bag[18] = bag[19] = 2;
  EXPECT_EQ(decode_bytes(bag).decoded.rows, 4U);
  const TemporaryDirectory directory;
  write_file(directory / "bag", bag);
  EXPECT_TRUE(decode_file(directory / "bag", directory / "out"));
  EXPECT_EQ(directory.entries().size(), 2U);
}

TEST(Rosbag2, RefusesWhatItCannotRead) {
  const InertialRow row = inertial_rows()[0];
  const std::vector<std::tuple<std::string, ErrorCode, std::string>> cases{
      {database("CREATE TABLE other(a);"), ErrorCode::ShapeMismatch, "tables `topics` and `messages`"},
      {database(kBag2Tables), ErrorCode::NoSamples, "'/log'"},
      {database(kBag2Tables + bag2_message(2, 1, zstd(cdr_imu(row)))), ErrorCode::UnsupportedType, "one by one"},
      {rosbag2(inertial_rows(40)).substr(0, 4096), ErrorCode::ShapeMismatch, "malformed"},
      {std::string("SQLite format 3\0", 16), ErrorCode::ShapeMismatch, "not a database"},
      // A view is a query that a stranger wrote: it is not run.
      {database("CREATE TABLE t(id INTEGER PRIMARY KEY, name, type, serialization_format);"
                "CREATE VIEW topics AS SELECT * FROM t; CREATE TABLE messages(topic_id, timestamp, data);"),
       ErrorCode::ShapeMismatch, "cannot be read"},
  };
  for (const auto& [bytes, code, says] : cases) {
    const Outcome outcome = decode_bytes(bytes);
    EXPECT_EQ(outcome.error, code) << outcome.message;
    EXPECT_THAT(outcome.message, HasSubstr(says));
  }
}

TEST(Rosbag2, EndsWhereItsPagesReferToEachOther) {
  // A page of a tree that names one page again and again makes more rows than the file has bytes; the root of such a
  // tree over others of its kind would be read until the end of days.
  std::string bag = rosbag2(inertial_rows(300));
  constexpr std::size_t kPage = 512;
  constexpr unsigned char kInterior = 5;
  std::size_t changed = 0;
  for (std::size_t page = kPage; page < bag.size(); page += kPage) {
    if (static_cast<unsigned char>(bag[page]) != kInterior) {
      continue;
    }
    const std::size_t cells =
        256 * static_cast<unsigned char>(bag[page + 3]) + static_cast<unsigned char>(bag[page + 4]);
    for (std::size_t i = 1; i < cells; ++i) {  // every cell becomes the first
      bag[page + 12 + 2 * i] = bag[page + 12];
      bag[page + 13 + 2 * i] = bag[page + 13];
    }
    changed += cells;
  }
  ASSERT_GT(changed, 4U);
  const Outcome outcome = decode_bytes(bag);
  EXPECT_TRUE(outcome.error || outcome.decoded.rows <= bag.size());
}

TEST(Rosbag2, KeepsACompressedBagInMemoryWithinItsLimit) {
  const std::string bag = rosbag2(inertial_rows());
  DecodeLimits limits;
  limits.max_tables_bytes = bag.size();
  EXPECT_FALSE(decode_bytes(zstd(bag), 4096, limits).error);
  limits.max_tables_bytes = bag.size() - 1;
  EXPECT_EQ(decode_bytes(zstd(bag), 4096, limits).error, ErrorCode::LimitExceeded);
}

}  // namespace
}  // namespace driftlab
