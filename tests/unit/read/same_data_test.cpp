// The same made-up numbers, written in a format by its published layout and as CSV, are the same columns: to the bit
// where the format holds binary floats, within its own step where it holds counts or decimals.
#include "core/read/column_file.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAreArray;

constexpr std::size_t kRows = 30;

using Columns = std::vector<std::vector<double>>;

/// Values of `width` columns that no two of their kind share: multiples of `step` about `offset`.
Columns made_up(std::size_t width, double step, double offset = 0.0) {
  Columns columns(width, std::vector<double>(kRows));
  for (std::size_t c = 0; c < width; ++c) {
    for (std::size_t i = 0; i < kRows; ++i) {
      columns[c][i] = offset + step * (static_cast<double>((7 * i + 11 * c) % 41) - 20.0);
    }
  }
  return columns;
}

std::vector<double> clock_of(double start_s, double step_s) {
  std::vector<double> time_s(kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    time_s[i] = start_s + step_s * static_cast<double>(i);
  }
  return time_s;
}

std::string digits(double value, const char* format = "%.17g") {
  std::array<char, 64> buffer{};
  const int size = std::snprintf(buffer.data(), buffer.size(), format, value);
  return {buffer.data(), static_cast<std::size_t>(size)};
}

/// The table as CSV with every digit.
std::string csv(const std::string& names, const Columns& columns) {
  std::string text = names + "\n";
  for (std::size_t i = 0; i < columns.front().size(); ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      text += (c == 0 ? "" : ",") + digits(columns[c][i]);
    }
    text += "\n";
  }
  return text;
}

Columns joined(std::initializer_list<Columns> parts) {
  Columns all;
  for (const Columns& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

Outcome decoded(const std::string& bytes, const std::string& format) {
  const Outcome outcome = decode_bytes(bytes);
  EXPECT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.format, format);
  return outcome;
}

std::size_t place_of(const Outcome& outcome, const std::string& name) {
  const auto& names = outcome.decoded.names;
  const auto found = std::find(names.begin(), names.end(), name);
  EXPECT_NE(found, names.end()) << name;
  return static_cast<std::size_t>(found - names.begin());
}

/// Every column of the CSV is in the other file under its name, each value within `tolerance`: 0 asks for the bits.
void expect_same(const Outcome& table, const Outcome& other, double tolerance = 0.0) {
  ASSERT_EQ(table.decoded.rows, kRows);
  ASSERT_EQ(other.decoded.rows, kRows);
  for (std::size_t c = 0; c < table.decoded.names.size(); ++c) {
    const std::string& name = table.decoded.names[c];
    const std::size_t at = place_of(other, name);
    ASSERT_LT(at, other.bits.size());
    if (tolerance == 0.0) {
      EXPECT_EQ(other.bits[at], table.bits[c]) << name;
      continue;
    }
    for (std::size_t i = 0; i < kRows; ++i) {
      EXPECT_NEAR(cell(other, at, i), cell(table, c, i), tolerance) << name << " row " << i;
    }
  }
}

TEST(SameData, InAnAxivityFileAsInCsvToTheBitOfItsCounts) {
  // Steps of the scales 250 deg/s and 1/2048 g, both powers of two times a decimal: counts and CSV name the same
  // double.
  const double gyro_step = 250.0 / 32768.0;
  const double acc_step = 1.0 / 2048.0;
  const Columns gyro = made_up(3, gyro_step);
  const Columns acc = made_up(3, 100 * acc_step);
  std::vector<int> counts;
  for (std::size_t i = 0; i < kRows; ++i) {
    for (const auto& axis : gyro) {
      counts.push_back(static_cast<int>(std::lround(axis[i] / gyro_step)));
    }
    for (const auto& axis : acc) {
      counts.push_back(static_cast<int>(std::lround(axis[i] / acc_step)));
    }
  }
  const Outcome file = decoded(cwa_header() + cwa_block({0, 7}, kRows, words_of(counts)), "cwa");
  const Columns temperature{std::vector<double>(kRows, 25.0)};
  expect_same(
      decoded(csv("gyro_x (deg/s),gyro_y (deg/s),gyro_z (deg/s),acc_x (g),acc_y (g),acc_z (g),temperature (degC)",
                  joined({gyro, acc, temperature})),
              "csv"),
      file);
  // A single block has no stamp behind it: its samples lie at the stated 100 Hz; ulp of seconds since 2000: 1.2e-7.
  expect_same(decoded(csv("time (s)", {clock_of(0.0, 0.01)}), "csv"), file, 1.2e-7);
}

TEST(SameData, InAGeneactivFileAsInCsvExactly) {
  // (100 counts - offset) / gain with gains of 25600: a step is 1/256 g; y is moved by half a unit, z turned.
  const Columns acc = made_up(3, 1.0 / 256.0);
  std::string samples;
  for (std::size_t i = 0; i < kRows; ++i) {
    const std::array<double, 3> counts{256.0 * acc[0][i], 256.0 * acc[1][i] + 128.0, -256.0 * acc[2][i]};
    for (const double count : counts) {
      std::array<char, 8> hexadecimal{};
      std::snprintf(hexadecimal.data(), hexadecimal.size(), "%03X", static_cast<unsigned>(std::lround(count)) & 0xFFFU);
      samples += hexadecimal.data();
    }
    samples += "000";
  }
  const Outcome file = decoded(geneactiv_header() + geneactiv_page(0, "2023-05-09 10:11:12:500", samples), "geneactiv");
  const Columns temperature{std::vector<double>(kRows, 21.5)};
  constexpr double kZeroOfEitherSign =
      1e-300;  // a negative gain gives a zero its sign; no two doubles else are as near
  expect_same(decoded(csv("acc_x (g),acc_y (g),acc_z (g),temperature (degC)", joined({acc, temperature})), "csv"), file,
              kZeroOfEitherSign);
  expect_same(decoded(csv("time (s)", {clock_of(0.0, 0.01)}), "csv"), file, 1e-6);  // ulp of a date: 2.4e-7 s
}

TEST(SameData, InSentencesOfAReceiverAsInCsvWithinTheirDigits) {
  const std::vector<double> time_s = clock_of(1672531170.0, 1.0);  // to the last second of 2022-12-31
  const Columns angles = made_up(2, 1e-4, 48.5);
  const Columns metres = made_up(1, 0.1, 250.0);
  const Columns sd = made_up(3, 0.001, 0.05);
  const Columns speed = made_up(1, 0.1, 10.0);  // knots
  std::string log;
  for (std::size_t i = 0; i < kRows; ++i) {
    std::array<char, 16> clock{};
    std::snprintf(clock.data(), clock.size(), "2359%02zu.00", 30 + i);
    const auto angle = [&](std::size_t c, const char* side) {
      const double degrees = std::floor(angles[c][i]);
      return digits(100.0 * degrees + 60.0 * (angles[c][i] - degrees), "%010.5f") + "," + side;
    };
    const std::string place = angle(0, "N") + "," + angle(1, "W");
    log += nmea_sentence(std::string("GPGGA,") + clock.data() + "," + place + ",4,12,0.9," +
                         digits(metres[0][i], "%.1f") + ",M,49.5,M,,") +
           nmea_sentence(std::string("GPRMC,") + clock.data() + ",A," + place + "," + digits(speed[0][i], "%.1f") +
                         ",90.5,311222,,,A") +
           nmea_sentence(std::string("GPGST,") + clock.data() + ",,,,," + digits(sd[0][i], "%.3f") + "," +
                         digits(sd[1][i], "%.3f") + "," + digits(sd[2][i], "%.3f"));
  }
  const Outcome file = decoded(log, "nmea");
  expect_same(decoded(csv("time (s)", {time_s}), "csv"), file);
  Columns west = angles;
  for (double& value : west[1]) {
    value = -value;
  }
  // Half a unit of the fifth digit of a minute.
  expect_same(decoded(csv("latitude (deg),longitude (deg)", west), "csv"), file, 0.51e-5 / 60.0);
  expect_same(decoded(csv("altitude (m),sd north (m),sd east (m),sd up (m)", joined({metres, sd})), "csv"), file,
              1e-12);
  Columns m_s = speed;
  for (double& value : m_s[0]) {
    value *= 1852.0 / 3600.0;
  }
  expect_same(decoded(csv("speed (m/s)", m_s), "csv"), file, 1e-12);
}

TEST(SameData, InFramesOfAUbloxReceiverAsInCsvWithinRoundingOfItsUnits) {
  const Columns angles = made_up(2, 1e-5, 48.5);
  const Columns height = made_up(1, 0.001, 300.0);
  const Columns velocity = made_up(3, 0.125);
  std::string log;
  for (std::size_t i = 0; i < kRows; ++i) {
    std::string p(92, '\0');
    const auto put = [&](std::size_t at, double value, std::size_t bytes) {
      p.replace(at, bytes, word(static_cast<std::uint64_t>(std::llround(value)), static_cast<int>(bytes)));
    };
    put(0, 243258000.0 + 250.0 * static_cast<double>(i), 4);
    put(4, 2025, 2);
    put(6, 7, 1);
    put(7, 8, 1);
    put(8, 19, 1);
    put(9, 34, 1);
    put(10, std::floor(0.25 * static_cast<double>(i)), 1);
    put(11, 7, 1);
    put(20, 3, 1);
    put(24, 1e7 * angles[1][i], 4);
    put(28, 1e7 * angles[0][i], 4);
    put(32, 1e3 * height[0][i], 4);
    for (std::size_t c = 0; c < 3; ++c) {
      put(48 + 4 * c, 1e3 * velocity[c][i], 4);
    }
    log += ubx_frame(1, 7, p);
  }
  const Outcome file = decoded(log, "ubx");
  expect_same(decoded(csv("time (s)", {clock_of(1752003258.0, 0.25)}), "csv"), file, 1e-6);  // 1e-3 times a count
  // Counts times a power of ten, which a double does not hold: an ulp or two.
  expect_same(decoded(csv("lat (deg),lon (deg),height (m),velN (m/s),velE (m/s),velD (m/s)",
                          joined({angles, height, velocity})),
                      "csv"),
              file, 1e-12);
}

TEST(SameData, InAKittiDriveAsInCsvToTheBit) {
  const Columns values = made_up(30, 0.1, 3.3);  // decimals that no double holds: both readers round alike
  std::vector<std::pair<std::string, std::string>> files;
  std::string stamps;
  for (std::size_t i = 0; i < kRows; ++i) {
    std::array<char, 64> name{};
    std::snprintf(name.data(), name.size(), "drive/oxts/data/%010zu.txt", i);
    std::string line;
    for (const auto& column : values) {
      line += digits(column[i]) + " ";
    }
    files.emplace_back(name.data(), line + "\n");
    std::snprintf(name.data(), name.size(), "2011-09-26 13:02:%02zu.%zu00000000\n", 10 + i / 10, i % 10);
    stamps += name.data();
  }
  files.emplace_back("drive/oxts/timestamps.txt", stamps);
  const Outcome file = decoded(zip(files), "kitti");
  ASSERT_EQ(file.bits.size(), 31U);
  Columns dated{clock_of(0.0, 0.1)};
  std::string names = "time (s)";
  for (std::size_t c = 1; c < file.decoded.names.size(); ++c) {
    names += "," + file.decoded.names[c];
  }
  const Outcome table = decoded(csv(names, joined({dated, values})), "csv");
  for (std::size_t c = 1; c < table.bits.size(); ++c) {
    EXPECT_EQ(file.bits[c], table.bits[c]) << file.decoded.names[c];
  }
  for (std::size_t i = 0; i < kRows; ++i) {
    EXPECT_NEAR(cell(file, 0, i), 1317042130.0 + cell(table, 0, i), 1e-6) << "ulp of a date: 2.4e-7 s";
  }
}

TEST(SameData, InTheLayoutOfEurocAsInCsvToTheBit) {
  const std::vector<InertialRow> rows = inertial_rows(kRows);
  Columns columns(7, std::vector<double>(kRows));
  for (std::size_t i = 0; i < kRows; ++i) {
    columns[0][i] = 1e-9 * 1e3 * static_cast<double>(rows[i].time_us - rows[0].time_us);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      columns[1 + axis][i] = rows[i].gyro_rad_s[axis];
      columns[4 + axis][i] = rows[i].accel_m_s2[axis];
    }
  }
  const Outcome file = decoded(euroc(rows), "euroc");
  ASSERT_EQ(file.decoded.names.size(), 7U);
  std::string names;
  for (const std::string& name : file.decoded.names) {
    names += (names.empty() ? "" : ",") + name;
  }
  const Outcome table = decoded(csv(names, columns), "csv");
  for (std::size_t c = 1; c < 7; ++c) {
    EXPECT_EQ(file.bits[c], table.bits[c]) << file.decoded.names[c];
  }
  expect_same(table, file, 1e-12);  // nanoseconds as seconds
}

TEST(SameData, InASequenceOfEurocAsInItsImuTableToTheBit) {
  const std::string content = euroc(inertial_rows(kRows));
  const Outcome alone = decoded(content, "euroc");
  const std::string camera = "#timestamp [ns],filename\n1700000000000000000,1700000000000000000.png\n";
  const std::string truth = "#timestamp, p_RS_R_x [m]\n1700000000000000000,0.5\n1700000000005000000,0.5\n";
  const std::vector<std::pair<std::string, std::string>> files{{"mav0/cam0/data.csv", camera},
                                                               {"mav0/imu0/data.csv", content},
                                                               {"mav0/imu0/sensor.yaml", "rate_hz: 200\n"},
                                                               {"mav0/state_groundtruth_estimate0/data.csv", truth}};
  const Outcome archive = decoded(zip(files), "euroc_zip");
  EXPECT_EQ(archive.decoded.names, alone.decoded.names);
  EXPECT_EQ(archive.bits, alone.bits);
  const TemporaryDirectory directory;
  for (const auto& [path, bytes] : files) {
    std::filesystem::create_directories((directory / path).parent_path());
    write_file(directory / path, bytes);
  }
  for (const std::string folder : {".", "mav0", "mav0/imu0"}) {
    const auto read = decode_file(directory / folder, directory / "columns");
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->format, "euroc_folder");
    EXPECT_EQ(read->names, alone.decoded.names);
    const auto columns = ColumnFile::open(directory / "columns");
    ASSERT_TRUE(columns);
    for (std::size_t c = 0; c < alone.bits.size(); ++c) {
      const auto values = columns->column(c);
      ASSERT_EQ(values.size(), kRows);
      for (std::size_t i = 0; i < kRows; ++i) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(values[i]), alone.bits[c][i]) << folder << " " << c << " " << i;
      }
    }
  }
  auto twice = files;
  twice.emplace_back("other/mav0/imu0/data.csv", content);
  EXPECT_THAT(decode_bytes(zip(twice)).message, HasSubstr("several sequences"));
  EXPECT_THAT(decode_bytes(zip({{"mav0/imu0/data.csv", "t,x\n1,2\n"}})).message, HasSubstr("send that file alone"));
}

TEST(SameData, OfHdf5AndMatlab73IsThatOfMatlab5NumpyAndCsvToTheBit) {
  // What the samples of hdf5_samples.hpp hold: quarters in `gyro`, eighths in `t`; for MATLAB 0 to 9 in two columns.
  const auto npy_of = [](const std::string& shape, const std::vector<double>& values) {
    return npy(npy_dictionary("<f8", false, shape), number_bytes<double>(values));
  };
  std::vector<double> rows(12);
  Columns columns(4, std::vector<double>(4));
  for (std::size_t i = 0; i < 12; ++i) {
    rows[i] = 0.25 * static_cast<double>(i);
    columns[i % 3][i / 3] = rows[i];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    columns[3][i] = 0.125 * static_cast<double>(i);
  }
  std::vector<double> down;
  for (std::size_t c = 0; c < 3; ++c) {
    down.insert(down.end(), columns[c].begin(), columns[c].end());
  }
  const Outcome hdf5 = decoded(unfolded(kHdf5File), "hdf5");
  for (const auto& [file, format] : std::vector<std::pair<std::string, std::string>>{
           {csv("gyro_x,gyro_y,gyro_z,t", columns), "csv"},
           {zip({{"gyro.npy", npy_of("(4, 3)", rows)}, {"t.npy", npy_of("(4,)", columns[3])}}), "npz"},
           {mat_file({mat_matrix("gyro", 4, 3, down), mat_matrix("t", 4, 1, columns[3])}), "mat5"},
           {mat_file({mat_matrix("gyro", 4, 3, down), mat_matrix("t", 4, 1, columns[3])}, true), "mat5"}}) {
    const Outcome other = decoded(file, format);
    EXPECT_EQ(other.decoded.names, hdf5.decoded.names) << format;
    EXPECT_EQ(other.bits, hdf5.bits) << format;
  }
  std::vector<double> ten(10);
  for (std::size_t i = 0; i < ten.size(); ++i) {
    ten[i] = static_cast<double>(i);
  }
  const Outcome matlab = decoded(unfolded(kMatlab73File), "hdf5");
  const Outcome older = decoded(mat_file({mat_matrix("gyro", 5, 2, ten)}), "mat5");
  EXPECT_EQ(older.decoded.names, matlab.decoded.names);
  EXPECT_EQ(older.bits, matlab.bits) << "MATLAB's columns are the library's rows";
}

TEST(SameData, InTheExportsOfPhonesAsInCsvToTheBit) {
  const Columns gyro = made_up(3, 0.01);
  const Columns acc = made_up(3, 0.1, 9.8);  // m/s^2 by its size, where Sensor Logger states none
  const std::vector<double> time_s = clock_of(0.0, 0.01);
  const std::string table =
      csv("time (s),Gyroscope X (rad/s),Gyroscope Y (rad/s),Gyroscope Z (rad/s),Accelerometer X (m/s^2),"
          "Accelerometer Y (m/s^2),Accelerometer Z (m/s^2)",
          joined({{time_s}, gyro, acc}));
  const auto phyphox = [&](const std::string& unit, const Columns& axes) {
    return csv("\"Time (s)\",\"X (" + unit + ")\",\"Y (" + unit + ")\",\"Z (" + unit + ")\"", joined({{time_s}, axes}));
  };
  const Outcome same = decoded(table, "csv");
  const Outcome export_of_phyphox = decoded(
      zip({{"Gyroscope.csv", phyphox("rad/s", gyro)}, {"Accelerometer.csv", phyphox("m/s^2", acc)}}), "phone_zip");
  EXPECT_EQ(export_of_phyphox.decoded.names, same.decoded.names);
  EXPECT_EQ(export_of_phyphox.bits, same.bits);
  const auto logger = [&](const Columns& axes) {  // the axes by name, not by place
    std::string text = "time,seconds_elapsed,z,y,x\n";
    for (std::size_t i = 0; i < kRows; ++i) {
      text += std::to_string(1700000000000000000 + 10000000 * i) + "," + digits(time_s[i]) + "," + digits(axes[2][i]) +
              "," + digits(axes[1][i]) + "," + digits(axes[0][i]) + "\n";
    }
    return text;
  };
  const Outcome export_of_logger =
      decoded(zip({{"Gyroscope.csv", logger(gyro)}, {"AccelerometerUncalibrated.csv", logger(acc)}}), "phone_zip");
  EXPECT_THAT(export_of_logger.decoded.names,
              ElementsAre("time (s)", "Gyroscope x (rad/s)", "Gyroscope y (rad/s)", "Gyroscope z (rad/s)",
                          "Accelerometer x (m/s^2)", "Accelerometer y (m/s^2)", "Accelerometer z (m/s^2)"));
  EXPECT_EQ(export_of_logger.bits, same.bits);
}

TEST(SameData, FixesInTheExportsOfPhonesAsInCsvToTheBit) {
  const std::string gyro = "\"Time (s)\",\"X (rad/s)\"\n0,0.1\n0.01,0.2\n0.02,0.3\n0.03,0.4\n";
  const std::string header = "time (s),Gyroscope X (rad/s),gnss_time (s),gnss_latitude (deg),gnss_longitude (deg),";
  const auto rows = [](const std::string& second, const std::string& third) {
    return "0,0.1," + second + "0.01,0.2," + third + "0.02,0.3,,,,,,,\n0.03,0.4,,,,,,,\n";
  };
  const auto numbers = [](const Outcome& outcome) {  // of what is missing, the reasons differ
    Columns columns;
    for (const auto& bits : outcome.bits) {
      auto& column = columns.emplace_back();
      std::transform(bits.begin(), bits.end(), std::back_inserter(column), [](std::uint64_t word) {
        const auto value = std::bit_cast<double>(word);
        return std::isnan(value) ? -999.0 : value;
      });
    }
    return columns;
  };
  const Outcome as_table = decoded(header +
                                       "gnss_altitude (m),gnss_speed (m/s),gnss_course (deg),"
                                       "gnss_sd_horizontal (m)\n" +
                                       rows("-0.5,48.1,9.1,312.5,1.5,90,4\n", "0.5,48.2,9.2,313.5,2.5,91,5\n"),
                                   "csv");
  const Outcome phyphox =
      decoded(zip({{"Gyroscope.csv", gyro},
                   {"Location.csv",
                    "\"Time (s)\",\"Latitude (\xC2\xB0)\",\"Longitude (\xC2\xB0)\",\"Height (m)\",\"Velocity (m/s)\","
                    "\"Direction (\xC2\xB0)\",\"Horizontal Accuracy (m)\"\n"
                    "-0.5,48.1,9.1,312.5,1.5,90,4\n0.5,48.2,9.2,313.5,2.5,91,5\n"}}),
              "phone_zip");
  EXPECT_EQ(phyphox.decoded.names, as_table.decoded.names);
  EXPECT_EQ(numbers(phyphox), numbers(as_table));

  const Outcome invalid =
      decoded(header + "gnss_height (m),gnss_speed (m/s),gnss_course (deg),gnss_sd_horizontal (m)\n" +
                  rows("-0.5,,,312.5,,90,\n", "0.5,48.2,9.2,313.5,2.5,,5\n"),
              "csv");
  const Outcome logger =
      decoded(zip({{"Gyroscope.csv", gyro},
                   {"Location.csv",
                    "time,seconds_elapsed,speed,bearing,altitude,longitude,latitude,horizontalAccuracy\n"
                    "1,9,9,9,9,9,9,9\n"},
                   {"LocationGps.csv",
                    "time,seconds_elapsed,speed,bearing,altitude,longitude,latitude,horizontalAccuracy\n"
                    "1,-0.5,-1,90,312.5,9.1,48.1,-1\n2,0.5,2.5,-1,313.5,9.2,48.2,5\n"}}),
              "phone_zip");
  EXPECT_THAT(logger.decoded.names, UnorderedElementsAreArray(invalid.decoded.names));
  EXPECT_THAT(numbers(logger), UnorderedElementsAreArray(numbers(invalid)));
  EXPECT_THAT(logger.decoded.notes, Contains(HasSubstr("'Location'"))) << "given twice";
}

TEST(SameData, MoreFixesThanRowsAreSaid) {
  const Outcome few =
      decoded(zip({{"Gyroscope.csv", "\"Time (s)\",\"X (rad/s)\"\n0,0.1\n0.01,0.2\n"},
                   {"Location.csv",
                    "\"Time (s)\",\"Latitude (\xC2\xB0)\",\"Longitude (\xC2\xB0)\"\n0,48,9\n1,48,9\n2,48,9\n"}}),
              "phone_zip");
  EXPECT_EQ(few.decoded.rows, 2U);
  EXPECT_THAT(few.decoded.notes,
              Contains("The export holds 3 fixes and fewer rows of 'Gyroscope'; the last 1 are left out."));
}

}  // namespace
}  // namespace driftlab
