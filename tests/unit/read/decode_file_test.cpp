#include "core/read/column_file.hpp"
#include "tests/shared_folder.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace driftlab {
namespace {

using testing::decode_bytes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::TemporaryDirectory;
using ::testing::UnorderedElementsAre;
using testing::write_file;
using namespace std::string_literals;

TEST(DecodeFile, WritesAColumnFileThatHoldsTheSamples) {
  const TemporaryDirectory directory;
  write_file(directory / "in", testing::gzip("t,gx\n0,1.5\n1,2.5\n2,-3.5\n"));
  const auto decoded = decode_file(directory / "in", directory / "out");
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->format, "csv");
  EXPECT_EQ(decoded->compression, Compression::Gzip);
  EXPECT_EQ(decoded->rows, 3U);
  const auto file = ColumnFile::open(directory / "out");
  ASSERT_TRUE(file);
  EXPECT_THAT(file->names(), ElementsAre("t", "gx"));
  EXPECT_THAT(file->column(1), ElementsAre(1.5, 2.5, -3.5));
}

TEST(DecodeFile, RefusesBadInputAndLeavesNothing) {
  const TemporaryDirectory directory;
  const std::vector<std::pair<std::string, ErrorCode>> cases{
      {"", ErrorCode::EmptyInput},
      {"gx,gy\n", ErrorCode::NoSamples},
      {"gx,gy\n1,2\n3\n", ErrorCode::RaggedRow},
      {"gx,gy\none,two\n", ErrorCode::NotANumber},
      {"gx\nnan\n", ErrorCode::NonFinite},
      {"gx\ninf\n", ErrorCode::NonFinite},
      {testing::npy(testing::npy_dictionary("<f8", false, "(3,)"), "0123456789"), ErrorCode::Truncated},
      {testing::npy(testing::npy_dictionary("<f8", false, "(1,)"), std::string(16, '\0')), ErrorCode::ShapeMismatch},
      {"PK\x03\x04", ErrorCode::UnsupportedFormat},
      {testing::zip({{"a.csv", "x\n1\n"}, {"b.csv", "x\n1\n"}}), ErrorCode::UnsupportedFormat},
  };
  for (const auto& [bytes, code] : cases) {
    write_file(directory / "in", bytes);
    const auto decoded = decode_file(directory / "in", directory / "out");
    ASSERT_FALSE(decoded);
    EXPECT_EQ(decoded.error().code, code) << decoded.error().message;
    EXPECT_THAT(directory.entries(), ElementsAre("in"));
  }
  EXPECT_EQ(decode_file(directory / "none", directory / "out").error().code, ErrorCode::NotFound);
}

TEST(DecodeFile, StopsWhenAskedAndLeavesNothing) {
  const TemporaryDirectory directory;
  std::string text = "gx\n";
  for (int i = 0; i < 400000; ++i) {
    text += "1\n";
  }
  write_file(directory / "in", text);
  std::stop_source stop;
  RunControl control;
  control.stop = stop.get_token();
  control.progress = [&stop](std::string_view, double) { stop.request_stop(); };
  const auto decoded = decode_file(directory / "in", directory / "out", {}, control);
  ASSERT_FALSE(decoded);
  EXPECT_EQ(decoded.error().code, ErrorCode::Cancelled);
  EXPECT_THAT(directory.entries(), ElementsAre("in"));
}

TEST(DecodeFile, ReportsProgressThatNeverFallsAndEndsAtOne) {
  const TemporaryDirectory directory;
  write_file(directory / "in", testing::npy(testing::npy_dictionary("<f8", true, "(100000, 2)"),
                                            testing::number_bytes<double>(testing::ramp(200000))));
  std::vector<double> fractions;
  RunControl control;
  control.progress = [&fractions](std::string_view stage, double fraction) {
    EXPECT_EQ(stage, "decode");
    fractions.push_back(fraction);
  };
  ASSERT_TRUE(decode_file(directory / "in", directory / "out", {}, control));
  ASSERT_GT(fractions.size(), 3U);
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST(Unknown, IsNamedByWhatItLooksLike) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"PK\x03\x04............................Gyroscope.jpg", "a ZIP archive"},
      {"PK\x03\x04............................[Content_Types].xml", "Office"},
      {"MATLAB 7.3 MAT-file, Platform: GLNXA64", "a MATLAB 7.3 file that is cut off"},
      {"TIMETAG RTKLIB demo5\0\0\0\0"s, "an RTKLIB time tag, which dates the log beside it"},
      {"%PDF-1.7\n%", "PDF"},
      {"\xb5\x62\x01\x07\x5c", "UBX"},
      {"$GPGGA,123519,4807.038,N,01131.000,E,1,08\n", "NMEA"},
      {"$GNRMC,1,2,3\n$GNRMC,1,2,3\n", "NMEA"},
      {"FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n", "send the .bin"},
      {"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s, "PNG"},
      {"\xff\xd8\xff\xe0\0\x10JFIF"s, "JPEG"},
      {"<!DOCTYPE html><html>", "HTML"},
      {"<?xml version=\"1.0\"?>", "XML"},
      {"{\"gx\": [1, 2]}", "JSON"},
      {"BZh91AY&SY", "bzip2"},
      {"\xff\xfeg\0x\0\n\0"s, "UTF-16"},
      {"\x00\x01\x02\x03\x04"s, "binary data"},
      {"\x89PNQ\x01\x02"s, "binary data"},
      {"t,gx\r0.00,1\r0.01,2\r", "carriage returns alone"},
      {"gx\r1\r2", "carriage returns alone"},
      {"once upon a time\nthere was a gyroscope", "not a table"},
  };
  for (const auto& [bytes, name] : cases) {
    const auto outcome = decode_bytes(bytes);
    EXPECT_EQ(outcome.error, ErrorCode::UnsupportedFormat) << name;
    EXPECT_THAT(outcome.message, HasSubstr(name));
    EXPECT_THAT(outcome.field("looks_like"), ::testing::AnyOf(HasSubstr("; "), HasSubstr("?"))) << "the next step";
  }
}

/// Where the recordings lie that may be used but not distributed; empty without them.
std::filesystem::path shared_data() {
  const auto shared = shared_folder();
  return shared ? *shared / "data" : std::filesystem::path();
}

TEST(RealRecordings, DecodeToTheirKnownShapeAndValues) {
  const auto data = shared_data();
  if (data.empty()) {
    GTEST_SKIP() << "SKIPPED: no real recordings; set DRIFTLAB_SHARED to the directory that holds data/";
  }
  const TemporaryDirectory directory;
  const auto npy = decode_file(data / "adis_16405_imu1.npy.xz", directory / "adis");
  ASSERT_TRUE(npy) << npy.error().message;
  EXPECT_EQ(npy->compression, Compression::Xz);
  EXPECT_EQ(npy->rows, 1'000'000U);
  EXPECT_EQ(npy->names.size(), 6U);
  const auto file = ColumnFile::open(directory / "adis");
  ASSERT_TRUE(file);
  // The device resolves 0.05 deg/s and 3.33 mg: the last row is 7, -4, -9 and -2, -1 steps.
  EXPECT_DOUBLE_EQ(file->column(0).back(), 0.35);
  EXPECT_DOUBLE_EQ(file->column(1).back(), -0.2);
  EXPECT_DOUBLE_EQ(file->column(2).back(), -0.45);
  EXPECT_DOUBLE_EQ(file->column(3).back(), -0.00666);
  EXPECT_DOUBLE_EQ(file->column(4).back(), -0.00333);

  const auto csv = decode_file(data / "st-mlc-logs/lsm6dsox_vehicle_stationary.csv", directory / "st");
  ASSERT_TRUE(csv) << csv.error().message;
  EXPECT_EQ(csv->rows, 4115U);
  EXPECT_THAT(csv->names,
              UnorderedElementsAre("acc_x[mg]", "acc_y[mg]", "acc_z[mg]", "gyro_x[dps]", "gyro_y[dps]", "gyro_z[dps]"));
}

TEST(RealRecordings, AreDecodedOrRefusedWithASentence) {
  const auto data = shared_data();
  if (data.empty()) {
    GTEST_SKIP() << "SKIPPED: no real recordings; set DRIFTLAB_SHARED to the directory that holds data/";
  }
  const TemporaryDirectory directory;
  std::size_t decoded_files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    if (!entry.is_regular_file()) {
      continue;
    }
    const auto decoded = decode_file(entry.path(), directory / "out");
    if (decoded) {
      ++decoded_files;
      std::filesystem::remove(directory / "out");
    } else {
      EXPECT_NE(decoded.error().code, ErrorCode::Internal) << entry.path();
      EXPECT_TRUE(decoded.error().message.ends_with('.')) << decoded.error().message;
    }
    EXPECT_THAT(directory.entries(), ::testing::IsEmpty());
  }
  EXPECT_GE(decoded_files, 30U);
}

TEST(DecodeFile, TheFolderOfARos2BagIsItsFile) {
  const TemporaryDirectory directory;
  const std::filesystem::path bag = directory / "drive";
  std::filesystem::create_directory(bag);
  write_file(bag / "metadata.yaml", "rosbag2_bagfile_information:\n");
  write_file(bag / "drive_0.db3", testing::journey_bag2());
  const auto alone = decode_file(bag, directory / "out");
  ASSERT_TRUE(alone) << alone.error().message;
  EXPECT_EQ(alone->format, "rosbag2");
  EXPECT_EQ(alone->rows, 40U);
  write_file(bag / "drive_1.db3", testing::journey_bag2());
  const auto split = decode_file(bag, directory / "out");
  ASSERT_FALSE(split);
  EXPECT_EQ(split.error().code, ErrorCode::UnsupportedFormat);
  EXPECT_THAT(split.error().message, HasSubstr("split into 2 files, 'drive_0.db3', 'drive_1.db3'"));
}

}  // namespace
}  // namespace driftlab
