// The GPS/IMU unit of KITTI raw drives: one moment a file, in an archive or a folder.
#include "core/read/column_file.hpp"
#include "core/signal/missing.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using namespace driftlab::testing;

TEST(Kitti, ReadsTheMomentsInTheOrderOfTheirNumbers) {
  auto files = kitti_files(12);
  std::swap(files.front(), files[11]);
  files.insert(files.begin(), {"2011_09_26/drive/image_00/timestamps.txt", "2011-09-26 13:02:10.000000000\n"});
  const Outcome outcome = decode_bytes(zip(files));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.format, "kitti");
  ASSERT_EQ(outcome.decoded.rows, 12U);
  EXPECT_NEAR(cell(outcome, 0, 0), 1317042130.0, 1e-6);
  EXPECT_NEAR(cell(outcome, 0, 11) - cell(outcome, 0, 0), 1.1, 1e-6);
  EXPECT_DOUBLE_EQ(cell(outcome, 1, 11), 49.00011);
  EXPECT_DOUBLE_EQ(cell(outcome, 14, 3), 9.8125);  // acceleration, up
  EXPECT_DOUBLE_EQ(cell(outcome, 18, 3), 0.125);   // rate, forward
  EXPECT_DOUBLE_EQ(cell(outcome, 20, 3), 0.0625);  // rate, up
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("forward, left, up")));
}

TEST(Kitti, LeavesOutMomentsWithoutAFileAndSaysSo) {
  auto files = kitti_files(6);
  files.erase(files.begin() + 2);
  files[3].second.clear();  // a receiver that lost its unit leaves an empty file
  const Outcome outcome = decode_bytes(zip(files));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 4U);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("2 dates have no sample")));
}

TEST(Kitti, RefusesWhatIsNoDriveByItsFile) {
  auto files = kitti_files(4);
  files[1].second = "1 2 3\n";
  const Outcome ragged = decode_bytes(zip(files));
  EXPECT_EQ(ragged.error, ErrorCode::RaggedRow);
  EXPECT_THAT(ragged.message, HasSubstr("0000000001.txt"));
  files[1].second = "49 8 north";
  for (int column = 3; column < 30; ++column) {
    files[1].second += " 0";
  }
  files[1].second += "\n";
  EXPECT_EQ(decode_bytes(zip(files)).error, ErrorCode::NotANumber);
  files = kitti_files(4);
  files.back().second = "yesterday\n";
  EXPECT_EQ(decode_bytes(zip(files)).error, ErrorCode::NotANumber);
  files = kitti_files(4);
  files.pop_back();
  EXPECT_EQ(decode_bytes(zip(files)).error, ErrorCode::NoSamples);
  files = kitti_files(4);
  const auto others = kitti_files(4, "2011_09_28/other/");
  files.insert(files.end(), others.begin(), others.end());
  EXPECT_EQ(decode_bytes(zip(files)).error, ErrorCode::UnsupportedFormat);
}

TEST(Kitti, ReadsTheSameFromAFolder) {
  const TemporaryDirectory directory;
  for (const auto& [path, content] : kitti_files(5, "drive/")) {
    std::filesystem::create_directories((directory / path).parent_path());
    write_file(directory / path, content);
  }
  const auto decoded = decode_file(directory / "drive", directory / "columns");
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->format, "kitti_folder");
  EXPECT_EQ(decoded->rows, 5U);
  const auto columns = ColumnFile::open(directory / "columns");
  ASSERT_TRUE(columns);
  const Outcome zipped = decode_bytes(zip(kitti_files(5, "drive/")));
  for (std::size_t i = 0; i < zipped.bits.size(); ++i) {
    EXPECT_EQ(columns->column(i)[4], cell(zipped, i, 4)) << i;
  }
}

TEST(Kitti, ReadsTheFolderOfADateWithOneDriveAndAsksWhichOfTwo) {
  const TemporaryDirectory directory;
  const auto write = [&](const std::string& drive) {
    for (const auto& [path, content] : kitti_files(5, "2011_09_26/" + drive + "/")) {
      std::filesystem::create_directories((directory / path).parent_path());
      write_file(directory / path, content);
    }
  };
  write("2011_09_26_drive_0001_sync");
  const auto one = decode_file(directory / "2011_09_26", directory / "columns");
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->format, "kitti_folder");
  EXPECT_EQ(one->rows, 5U);
  write("2011_09_26_drive_0002_sync");
  const auto two = decode_file(directory / "2011_09_26", directory / "columns");
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().message, "The directory '2011_09_26' holds 2 KITTI drives; name the directory of one of them.");
}

}  // namespace
}  // namespace driftlab
