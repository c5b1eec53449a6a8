/// Formats of several tables: .npz, MATLAB 5, the exports of phone applications, and the board that writes hexadecimal
/// words.
#include "core/signal/missing.hpp"
#include "core/signal/recording.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace driftlab {
namespace {

using ::testing::Contains;
using testing::decode_bytes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::mat_element;
using testing::mat_file;
using testing::mat_head;
using testing::mat_matrix;
using testing::npy;
using testing::npy_dictionary;
using testing::number_bytes;
using testing::Outcome;
using testing::ramp;
using testing::word;
using testing::zip;

std::vector<double> column(const Outcome& outcome, std::size_t i) {
  std::vector<double> values;
  for (const std::uint64_t bits : outcome.bits.at(i)) {
    values.push_back(std::bit_cast<double>(bits));
  }
  return values;
}

std::string array(const std::string& shape, std::size_t count, const std::string& type = "<f8") {
  return npy(npy_dictionary(type, false, shape), number_bytes<double>(ramp(count)));
}

TEST(Npz, SetsTheArraysOfOneLengthSideBySide) {
  const Outcome outcome = decode_bytes(zip({{"gyro.npy", array("(4, 3)", 12)},
                                            {"t.npy", array("(4,)", 4)},
                                            {"other.npy", array("(7,)", 7)},
                                            {"n.npy", array("(4,)", 4, "<M8")}}));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("gyro_x", "gyro_y", "gyro_z", "t"));
  EXPECT_THAT(column(outcome, 1), ElementsAre(-2.75, -2.0, -1.25, -0.5));
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'other' (7 x 1)")));
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'n' is left out")));
}

TEST(Hdf5, ReadsArraysAndThoseOfMatlabTheOtherWayRound) {
  const Outcome plain = decode_bytes(testing::unfolded(testing::kHdf5File));
  ASSERT_FALSE(plain.error) << plain.message;
  EXPECT_THAT(plain.decoded.names, ElementsAre("gyro_x", "gyro_y", "gyro_z", "t"));
  EXPECT_EQ(plain.decoded.rows, 4U);
  EXPECT_EQ(column(plain, 1)[2], 7.0 / 4.0);
  EXPECT_EQ(column(plain, 3)[3], 3.0 / 8.0);
  const Outcome matlab = decode_bytes(testing::unfolded(testing::kMatlab73File));
  ASSERT_FALSE(matlab.error) << matlab.message;
  EXPECT_THAT(matlab.decoded.names, ElementsAre("gyro_0", "gyro_1"));
  EXPECT_EQ(matlab.decoded.rows, 5U);
  EXPECT_EQ(column(matlab, 1)[2], 7.0);
}

TEST(Hdf5, ReadsTheRateOfTheRootAndLeavesOutAnArrayBehindAnUnknownFilter) {
  // The rate of the shared recording of BROAD is an attribute; and one array of lzf made the file a damaged one.
  const Outcome outcome = decode_bytes(testing::unfolded(testing::kHdf5UnknownFilter));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("gyro_x", "gyro_y", "gyro_z", "time (s)"));
  EXPECT_DOUBLE_EQ(column(outcome, 3)[3], 3.0 / 285.5);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'acc' is left out: it is packed with the filter 'lzf'")));
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("states 285.5 Hz")));
  const Outcome alone = decode_bytes(testing::unfolded(testing::kHdf5UnknownFilterAlone));
  EXPECT_EQ(alone.error, ErrorCode::NoSamples);
  EXPECT_THAT(alone.message, HasSubstr("h5repack -f GZIP=4"));
}

TEST(Hdf5, ReadsTheRateOfTheGroupOfItsArrays) {
  const Outcome outcome = decode_bytes(testing::unfolded(testing::kHdf5RatesOfGroups));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("imu.gyro_x", "imu.gyro_y", "imu.gyro_z", "time (s)"));
  EXPECT_DOUBLE_EQ(column(outcome, 3)[3], 3.0 / 50.0);
}

TEST(Mat5, UsesNoneOfTwoRatesThatContradictEachOther) {
  const Outcome outcome = decode_bytes(
      mat_file({mat_matrix("w", 20, 1, ramp(20)), mat_matrix("fs", 1, 1, {100.0}), mat_matrix("rate", 1, 1, {50.0})}));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("w"));
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("states several rates")));
}

TEST(Hdf5, RefusesWhatIsCutOffInASentence) {
  const std::string whole = testing::unfolded(testing::kHdf5File);
  const Outcome cut = decode_bytes(whole.substr(0, whole.size() / 3));
  EXPECT_EQ(cut.error, ErrorCode::ShapeMismatch);
  EXPECT_THAT(cut.message, HasSubstr("damaged"));
}

TEST(Mat5, ReadsMatricesOfEitherDirectionAndTheRate) {
  for (const bool compressed : {false, true}) {
    const Outcome outcome = decode_bytes(
        mat_file({mat_matrix("gyr", 3, 20, ramp(60)), mat_matrix("w", 20, 1, ramp(20)), mat_matrix("fs", 1, 1, {50.0})},
                 compressed));
    ASSERT_FALSE(outcome.error) << outcome.message;
    EXPECT_THAT(outcome.decoded.names, ElementsAre("gyr_x", "gyr_y", "gyr_z", "w", "time (s)"));
    EXPECT_EQ(outcome.decoded.rows, 20U);
    EXPECT_EQ(column(outcome, 1)[2], ramp(60)[7]);
    EXPECT_DOUBLE_EQ(column(outcome, 4)[19], 0.38);
  }
}

TEST(Mat5, TakesNoRateThatTimeWouldNotStayFiniteWith) {
  for (const double rate : {0.0, -50.0, 3e-310, 1e300, std::numeric_limits<double>::infinity()}) {
    const Outcome outcome = decode_bytes(mat_file({mat_matrix("w", 20, 1, ramp(20)), mat_matrix("fs", 1, 1, {rate})}));
    ASSERT_FALSE(outcome.error) << outcome.message;
    EXPECT_THAT(outcome.decoded.names, ElementsAre("w")) << rate;
    EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'fs' (1 x 1)")));
  }
}

TEST(Mat5, ReadsStructsAndIntegersAndLeavesOutTheRest) {
  const std::string field_names = std::string("t\0\0\0fb\0\0", 8);
  const std::string counts =
      mat_element(14, mat_head(10, 3, 1, "") + mat_element(3, word(1, 2) + word(0xFFFF, 2) + word(3, 2)));
  const std::string imu = mat_element(14, mat_head(2, 1, 1, "imu") + word(4U << 16U | 5U, 4) + word(4, 4) +
                                              mat_element(1, field_names) + counts + mat_matrix("", 3, 3, ramp(9)));
  const std::string text = mat_element(14, mat_head(4, 1, 2, "unit") + mat_element(16, "ms"));
  const Outcome outcome = decode_bytes(mat_file({imu, text}));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("imu.t", "imu.fb_x", "imu.fb_y", "imu.fb_z"));
  EXPECT_THAT(column(outcome, 0), ElementsAre(1.0, -1.0, 3.0));
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'unit' (char)")));
}

/// A struct of NaveGo with its rate, its parameters left out.
std::string navego_struct(const std::string& name) {
  const std::string names = std::string("t\0\0\0\0wb\0\0\0fb\0\0\0freq\0", 20);
  return mat_element(14, mat_head(2, 1, 1, name) + word(4U << 16U | 5U, 4) + word(5, 4) + mat_element(1, names) +
                             mat_matrix("", 4, 1, {0.0, 0.01, 0.02, 0.03}) + mat_matrix("", 4, 3, ramp(12)) +
                             mat_matrix("", 4, 3, ramp(12)) + mat_matrix("", 1, 1, {100.0}));
}

TEST(Mat5, KnowsAStructOfNavegoByItsMembersUnderAnyName) {
  for (const std::string name : {"imu", "imu1", "imu_planetary", "adis16488"}) {
    const Outcome outcome = decode_bytes(mat_file({navego_struct(name), mat_matrix("other", 5, 4, ramp(20))}));
    ASSERT_FALSE(outcome.error) << outcome.message;
    EXPECT_THAT(outcome.decoded.names, ElementsAre(name + ".t", name + ".wb_x", name + ".wb_y", name + ".wb_z",
                                                   name + ".fb_x", name + ".fb_y", name + ".fb_z"))
        << "its time is the time, and its length that of the recording";
    EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'" + name + "' is a struct of NaveGo")));
    const auto roles = assign_roles({}, outcome.decoded.names);
    ASSERT_TRUE(roles) << roles.error().message;
    const auto said = [&](std::size_t i) {
      const ColumnRole role = (*roles)[i].value_or(ColumnRole{});
      return std::string(name_of(role.quantity)) + " " + role.axis + " " + role.unit.value_or(Unit{}).symbol;
    };
    EXPECT_EQ(said(0), "time  s");
    EXPECT_EQ(said(2), "angular_rate y rad/s");
    EXPECT_EQ(said(6), "specific_force z m/s^2");
  }
  const auto apart = assign_roles({}, {"unit.t", "unit.wb_x", "unit.wb_y", "unit.wb_z"});
  ASSERT_TRUE(apart) << apart.error().message;
  EXPECT_EQ((*apart)[1]->quantity, Quantity::Unspecified) << "half of the members say nothing";
}

TEST(Mat5, KeepsNanAsAMissingSample) {
  const Outcome outcome = decode_bytes(mat_file({mat_matrix("gx", 3, 1, {1.0, std::nan(""), 2.0})}));
  ASSERT_FALSE(outcome.error);
  const MissingSample hole = why_missing(column(outcome, 0)[1]);
  EXPECT_EQ(hole.why, Missing::Nan);
  EXPECT_EQ(hole.row, 2U);
}

TEST(Mat5, RefusesWhatContradictsItself) {
  EXPECT_EQ(decode_bytes("MATLAB 5.0 MAT-file, Platform: GLNXA64").error, ErrorCode::Truncated);
  EXPECT_EQ(decode_bytes(mat_file({mat_matrix("gx", 4, 1, ramp(3))})).error, ErrorCode::ShapeMismatch);
  EXPECT_EQ(decode_bytes(mat_file({mat_matrix("gx", 1U << 30U, 1U << 30U, ramp(3))})).error, ErrorCode::ShapeMismatch);
  EXPECT_EQ(decode_bytes(mat_file({mat_matrix("gx", 1, 1, {1.0})})).error, ErrorCode::NoSamples);
  EXPECT_EQ(decode_bytes(mat_file({})).error, ErrorCode::NoSamples);
  const std::string whole = mat_file({mat_matrix("gx", 3, 1, ramp(3))});
  EXPECT_EQ(decode_bytes(whole.substr(0, whole.size() - 8)).error, ErrorCode::Truncated);
}

TEST(Mat5, StopsAnArrayThatExpandsWithoutEnd) {
  DecodeLimits limits;
  limits.expansion_allowance = 1 << 20;
  limits.expansion_ratio = 0;
  const Outcome outcome =
      decode_bytes(mat_file({mat_matrix("gx", 1 << 19, 1, std::vector<double>(1 << 19))}, true), 1 << 20, limits);
  EXPECT_EQ(outcome.error, ErrorCode::DecompressionLimit);
}

/// "Time (s)","X (rad/s)",... as phyphox quotes it.
std::string header(const std::string& unit, char separator) {
  std::string text = "\"Time (s)\"";
  for (const char axis : {'X', 'Y', 'Z'}) {
    text += separator;
    text += "\"" + std::string(1, axis) + " (" + unit + ")\"";
  }
  return text;
}

/// `count` rows of time and three axes from `start`, `dt` apart; axis values 1, 2, 3 plus the row.
std::string table(const std::string& names, double start, double dt, int count, const char separator = ',') {
  std::string text = names + "\n";
  for (int i = 0; i < count; ++i) {
    text += std::to_string(start + dt * i);
    for (int axis = 1; axis <= 3; ++axis) {
      text += separator + std::to_string(axis + 10 * i);
    }
    text += "\n";
  }
  return text;
}

TEST(PhoneExport, SetsTheSensorsOfPhyphoxSideBySideByTheirTime) {
  const std::string gyro = table(header("rad/s", ','), 0.0, 0.01, 50);
  // Starts two samples and a bit later, stops five rows earlier.
  const std::string acc = table(header("m/s^2", ','), 0.022, 0.01, 43);
  const std::string linear = table(header("m/s^2", ','), 0.0, 0.01, 50);
  const Outcome outcome = decode_bytes(zip({{"Accelerometer.csv", acc},
                                            {"Gyroscope.csv", gyro},
                                            {"Linear Accelerometer.csv", linear},
                                            {"meta/device.csv", "property,value\na,b\n"}}));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names,
              ElementsAre("time (s)", "Gyroscope X (rad/s)", "Gyroscope Y (rad/s)", "Gyroscope Z (rad/s)",
                          "Accelerometer X (m/s^2)", "Accelerometer Y (m/s^2)", "Accelerometer Z (m/s^2)"));
  ASSERT_EQ(outcome.decoded.rows, 50U);
  EXPECT_EQ(column(outcome, 2)[7], 72.0);
  const std::vector<double> x = column(outcome, 4);
  EXPECT_TRUE(std::isnan(x[1]));
  EXPECT_EQ(x[2], 1.0);
  EXPECT_EQ(x[44], 421.0);
  EXPECT_EQ(why_missing(x[45]).why, Missing::Ended);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("starts 0.0220 s after")));
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'Linear Accelerometer'")));
}

TEST(PhoneExport, ReadsTheOneTableOfPhyphoxBesideWhatItSaysOfThePhone) {
  const std::string names = "\"Time (s)\",\"Gyroscope x (rad/s)\",\"Gyroscope y (rad/s)\",\"Gyroscope z (rad/s)\"";
  for (const std::string folder : {"", "Gyroscope 2025-06-14/"}) {
    const Outcome outcome = decode_bytes(zip(
        {{folder + "Raw Data.csv", table(names, 0.0, 0.01, 50)},
         {folder + "meta/device.csv", "\"property\",\"value\"\n\"version\",\"1.1.11\"\n\"depthFrontSensor\",\"0\"\n"},
         {folder + "meta/time.csv",
          "\"event\",\"experiment time\",\"system "
          "time\"\n\"START\",0.0E0,1690000000.123\n\"PAUSE\",2.0E1,1690000020.1\n"}}));
    ASSERT_FALSE(outcome.error) << outcome.message;
    EXPECT_THAT(outcome.decoded.names,
                ElementsAre("Time (s)", "Gyroscope x (rad/s)", "Gyroscope y (rad/s)", "Gyroscope z (rad/s)"));
    EXPECT_EQ(outcome.decoded.rows, 50U);
  }
}

TEST(PhoneExport, ReadsTheDelimitersAndDecimalCommaOfPhyphox) {
  std::string gyro = table(header("rad/s", ';'), 0.0, 0.01, 50, ';');
  std::replace(gyro.begin(), gyro.end(), '.', ',');
  const Outcome outcome = decode_bytes(zip({{"export/Gyroscope.csv", gyro}}));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.names.size(), 4U);
  EXPECT_DOUBLE_EQ(column(outcome, 0)[49], 0.49);
}

std::string logger_table(double dt, int count, double scale) {
  std::string text = "time,seconds_elapsed,z,y,x\n";
  for (int i = 0; i < count; ++i) {
    text += std::to_string(1700000000000000000 + i * 10000000LL) + "," + std::to_string(dt * i) + "," +
            std::to_string(scale) + ",0.2,0.1\n";
  }
  return text;
}

TEST(PhoneExport, ReadsTheAxesOfSensorLoggerByNameAndItsUnitBySize) {
  const Outcome outcome = decode_bytes(zip({{"Gyroscope.csv", logger_table(0.01, 40, 0.3)},
                                            {"GyroscopeUncalibrated.csv", logger_table(0.01, 40, 0.3)},
                                            {"Accelerometer.csv", logger_table(0.01, 40, 0.0)},
                                            {"AccelerometerUncalibrated.csv", logger_table(0.01, 40, -1.0)},
                                            {"Gravity.csv", logger_table(0.01, 40, 9.8)},
                                            {"Annotation.csv", ""},
                                            {"Metadata.csv", "version,device name\n3,phone\n"}}));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names,
              ElementsAre("time (s)", "Gyroscope x (rad/s)", "Gyroscope y (rad/s)", "Gyroscope z (rad/s)",
                          "Accelerometer x (g)", "Accelerometer y (g)", "Accelerometer z (g)"));
  EXPECT_EQ(column(outcome, 1)[0], 0.1);
  EXPECT_EQ(column(outcome, 3)[0], 0.3);
  EXPECT_EQ(column(outcome, 6)[0], -1.0);
}

TEST(PhoneExport, LeavesOutASensorOfAnotherRate) {
  const std::string names = header("rad/s", ',');
  const Outcome outcome = decode_bytes(
      zip({{"Gyroscope.csv", table(names, 0.0, 0.01, 50)}, {"Accelerometer.csv", table(names, 0.0, 0.02, 25)}}));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.names.size(), 4U);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("another rate")));
}

TEST(PhoneExport, ReadsAFolderAsItReadsAnArchive) {
  const testing::TemporaryDirectory directory;
  const std::string gyro = table(header("rad/s", ','), 0.0, 0.01, 50);
  std::filesystem::create_directory(directory / "export");
  testing::write_file(directory / "export/Gyroscope.csv", gyro);
  const auto decoded = decode_file(directory / "export", directory / "out");
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->format, "phone_folder");
  EXPECT_EQ(decoded->rows, 50U);
}

TEST(PhoneExport, CallsADirectoryWithoutSensorsADirectory) {
  const testing::TemporaryDirectory directory;
  std::filesystem::create_directory(directory / "campaign");
  const auto said = [&] {
    const auto decoded = decode_file(directory / "campaign", directory / "out");
    return decoded ? std::string("decoded") : decoded.error().message;
  };
  EXPECT_EQ(said(), "The directory holds no table of samples.");
  testing::write_file(directory / "campaign/a.csv", "x\n1\n");
  testing::write_file(directory / "campaign/b.csv", "x\n1\n");
  EXPECT_THAT(said(), HasSubstr("The directory holds 2 tables"));
}

/// Bytes that do not compress, as those of a picture.
std::string picture(std::size_t size) {
  std::string bytes;
  std::uint64_t state = 1;
  while (bytes.size() < size) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    bytes += static_cast<char>(state >> 56U);
  }
  return bytes;
}

TEST(Zip, IsRecognisedBehindPicturesThatComeFirst) {
  const testing::TemporaryDirectory directory;
  const std::string gyro = table(header("rad/s", ','), 0.0, 0.01, 50);
  auto drive = testing::kitti_files(3);
  drive.insert(drive.begin(), {"2011_09_26/drive/image_00/data/0000000000.png", picture(200'000)});
  const std::vector<std::pair<std::string, std::string>> archives{
      {"phone_zip", zip({{"Camera/1.jpg", picture(200'000)}, {"Gyroscope.csv", gyro}})},
      {"kitti", zip(drive)},
      {"npz", zip({{"picture.jpg", picture(200'000)}, {"gyro.npy", array("(4, 3)", 12)}})}};
  for (const auto& [format, bytes] : archives) {
    const Outcome streamed = decode_bytes(testing::xz(bytes));
    EXPECT_FALSE(streamed.error) << streamed.message;
    EXPECT_EQ(streamed.decoded.format, format);
    testing::write_file(directory / "in", bytes);
    const auto decoded = decode_file(directory / "in", directory / "out");
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(decoded->format, format);
  }
  // Behind more than is looked through, the directory at the end says it.
  testing::write_file(directory / "in", zip({{"film.mp4", picture(17U << 20U)}, {"Gyroscope.csv", gyro}}));
  const auto decoded = decode_file(directory / "in", directory / "out");
  ASSERT_TRUE(decoded) << decoded.error().message;
  EXPECT_EQ(decoded->rows, 50U);
}

TEST(Zip, IsRecognisedByADirectoryOf64Bits) {
  const testing::TemporaryDirectory directory;
  const std::string whole =
      zip({{"film.mp4", picture(200'000)}, {"Gyroscope.csv", table(header("rad/s", ','), 0.0, 0.01, 50)}});
  const std::size_t begin = whole.find("PK\x01\x02");
  const std::size_t end = whole.rfind("PK\x05\x06");
  const std::string record = "PK\x06\x06" + word(44, 8) + word(45, 2) + word(45, 2) + word(0, 8) + word(2, 8) +
                             word(2, 8) + word(end - begin, 8) + word(begin, 8);
  for (const std::uint64_t place : {std::uint64_t{end}, ~std::uint64_t{0}}) {
    const std::string locator = "PK\x06\x07" + word(0, 4) + word(place, 8) + word(1, 4);
    std::string file = whole;
    file.replace(end + 16, 4, word(0xFFFFFFFF, 4));
    file.insert(end, record + locator);
    testing::write_file(directory / "in", file);
    const auto decoded = decode_file(directory / "in", directory / "out");
    ASSERT_TRUE(decoded) << decoded.error().message;
    EXPECT_EQ(decoded->rows, 50U) << "by the files themselves where the record lies nowhere";
  }
}

TEST(Zip, IsRecognisedByItsFilesWhereItsDirectoryIsDamaged) {
  const testing::TemporaryDirectory directory;
  const std::string whole = zip({{"Gyroscope.csv", table(header("rad/s", ','), 0.0, 0.01, 50)}});
  const std::size_t entry = whole.find("PK\x01\x02");
  const std::size_t end = whole.find("PK\x05\x06");
  for (const std::size_t at : {entry, entry + 28, end, end + 16, end + 19}) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x7F);
    testing::write_file(directory / "in", damaged);
    const auto decoded = decode_file(directory / "in", directory / "out");
    if (!decoded) {
      EXPECT_NE(decoded.error().code, ErrorCode::Internal) << decoded.error().message;
      EXPECT_NE(decoded.error().code, ErrorCode::UnsupportedFormat) << at << decoded.error().message;
    }
  }
}

TEST(Zip, NamesWhatItCannotRead) {
  EXPECT_THAT(decode_bytes(zip({{"a.csv", "x\n1\n"}, {"b.csv", "x\n1\n"}})).message, HasSubstr("holds 2 tables"));
  EXPECT_EQ(decode_bytes(zip({{"only.csv", "t,gx\n0,1\n1,2\n"}})).decoded.rows, 2U);
  const std::string whole = zip({{"Gyroscope.csv", table(header("rad/s", ','), 0.0, 0.01, 500)}});
  EXPECT_EQ(decode_bytes(whole.substr(0, whole.size() / 2)).error, ErrorCode::Truncated);
  DecodeLimits limits;
  limits.expansion_allowance = 4096;
  limits.expansion_ratio = 0;
  EXPECT_EQ(decode_bytes(whole, 1 << 20, limits).error, ErrorCode::DecompressionLimit);
}

TEST(Vmu931, SortsTheRowsByTheirSensor) {
  const Outcome outcome =
      decode_bytes("Attribute,Time stamp,x,y,z\nG,10,1,2,3\nA,10,0.1,0.2,1\nG,11,4,5,6\nE,11,0,0,0\nA,11,0.1,0.3,1\n");
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.format, "vmu931");
  EXPECT_THAT(outcome.decoded.names,
              ElementsAre("time (s)", "Gyroscope x (deg/s)", "Gyroscope y (deg/s)", "Gyroscope z (deg/s)",
                          "Accelerometer x (g)", "Accelerometer y (g)", "Accelerometer z (g)"));
  EXPECT_THAT(column(outcome, 2), ElementsAre(2.0, 5.0));
  EXPECT_THAT(column(outcome, 5), ElementsAre(0.2, 0.3));
  EXPECT_DOUBLE_EQ(column(outcome, 0)[1], 0.011);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("1 row of other attributes is left out")));
}

TEST(Cxd5602, ContinuesTheCounterAndReadsFloats) {
  const Outcome outcome = decode_bytes(
      "ffffff00,41d84d00,3f800000,bf800000,00000000,40000000,c0000000,411c0000\n"
      "0000ee6c,41d84d00,7fc00000,bf800000,00000000,40000000,c0000000,411c0000\n");
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.format, "cxd5602");
  EXPECT_DOUBLE_EQ(column(outcome, 0)[1], (0x100 + 0xee6c) / 19.2e6);
  EXPECT_EQ(column(outcome, 2)[0], 1.0);
  EXPECT_EQ(why_missing(column(outcome, 2)[1]).why, Missing::Nan);
  EXPECT_EQ(column(outcome, 7)[0], 9.75);
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("started again once; the time goes on")));
}

}  // namespace
}  // namespace driftlab
