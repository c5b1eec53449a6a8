// Bad input of drives: each is refused with its sentence, or survived with one among the notes (spec/drives.md, 8).
#include "core/signal/missing.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace driftlab::drive {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

struct Files {
  Document document;
  Tables tables;

  std::vector<double>& column(Table& table, std::string_view name) {
    const auto at = std::find(table.names.begin(), table.names.end(), name);
    return table.columns[static_cast<std::size_t>(at - table.names.begin())];
  }
  std::vector<double>& imu(std::string_view name) { return column(tables.imu, name); }
  std::vector<double>& gnss(std::string_view name) { return column(tables.gnss, name); }
};

/// The town's drive as its files would hold it, over hills that the fixes alone know of.
Files town() {
  const Drive drive = simulated_drive(71);
  Files files;
  files.document = drive.document;
  Source& unit = files.document.imu.source;
  unit.file = "imu.csv";
  unit.time.column = "t";
  files.tables.imu.names = {"t", "gx", "gy", "gz", "ax", "ay", "az"};
  files.tables.imu.columns.resize(7);
  const UniformRun& run = drive.runs.front();
  for (std::size_t i = 0; i < run.readings.size(); ++i) {
    files.tables.imu.columns[0].push_back(run.dt_s * static_cast<double>(i + 1));
    for (std::size_t c = 0; c < kImuChannels; ++c) {
      files.tables.imu.columns[c + 1].push_back(run.readings[i][c]);
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    unit.columns["g" + axis] = {Quantity::AngularRate, axis, 1.0};
    unit.columns["a" + axis] = {Quantity::SpecificForce, axis, 1.0};
  }
  GnssSource& gnss = files.document.gnss;
  gnss.source.file = "gnss.csv";
  gnss.source.time.column = "t";
  gnss.source.columns = {{"lat", {Quantity::GnssPosition, "lat", 1.0}},
                         {"lon", {Quantity::GnssPosition, "lon", 1.0}},
                         {"h", {Quantity::GnssPosition, "height", 1.0}},
                         {"vn", {Quantity::GnssVelocity, "north", 1.0}},
                         {"ve", {Quantity::GnssVelocity, "east", 1.0}},
                         {"vd", {Quantity::GnssVelocity, "down", 1.0}},
                         {"sd", {Quantity::GnssAccuracy, "horizontal", 1.0}},
                         {"sdv", {Quantity::GnssAccuracy, "vertical", 1.0}},
                         {"type", {Quantity::FixType, "", 1.0}}};
  files.tables.gnss.names = {"t", "lat", "lon", "h", "vn", "ve", "vd", "sd", "sdv", "type"};
  files.tables.gnss.columns.resize(10);
  for (const Fix& fix : drive.fixes) {
    const Geodetic place = to_geodetic(fix.position_ecef_m);
    const Vector3& v = *fix.velocity_ned_m_s;
    const double t = fix.time_s;
    const double values[] = {t,
                             place.latitude_rad,
                             place.longitude_rad,
                             place.height_m + 5.0 * std::sin(0.3 * t),
                             v.x(),
                             v.y(),
                             v.z() - 1.5 * std::cos(0.3 * t),
                             1.0 + 0.1 * std::sin(t),
                             2.0 + 0.1 * std::sin(t),
                             1.0};
    for (std::size_t c = 0; c < 10; ++c) {
      files.tables.gnss.columns[c].push_back(values[c]);
    }
  }
  return files;
}

/// Speed and course in place of the velocity.
void by_course(Files& files) {
  auto& columns = files.document.gnss.source.columns;
  columns.erase("vd");
  columns["vn"] = {Quantity::GnssSpeed, "", 1.0};
  columns["ve"] = {Quantity::GnssCourse, "", 1.0};
  for (std::size_t i = 0; i < files.gnss("vn").size(); ++i) {
    const double north = files.gnss("vn")[i];
    const double east = files.gnss("ve")[i];
    const double speed = std::hypot(north, east);
    files.gnss("vn")[i] = speed < 0.5 ? 0.0 : speed;
    files.gnss("ve")[i] = speed < 0.5 ? 0.0 : std::atan2(east, north);
  }
}

void own_reference(Files& files, double beside_rad) {
  Table reference = files.tables.gnss;
  for (double& latitude : reference.columns[1]) {
    latitude += beside_rad;
  }
  files.document.reference.source = files.document.gnss.source;
  files.document.reference.source->columns = {{"lat", {Quantity::ReferencePosition, "lat", 1.0}},
                                              {"lon", {Quantity::ReferencePosition, "lon", 1.0}},
                                              {"h", {Quantity::ReferencePosition, "height", 1.0}}};
  files.tables.reference = std::move(reference);
}

/// The fixes in columns beside the unit's rows, as a flight log or a bag gives them.
void in_one_file(Files& files) {
  Source& source = files.document.gnss.source;
  const std::size_t rows = files.tables.imu.rows();
  std::map<std::string, ColumnMeaning> columns;
  for (const auto& [name, meaning] : source.columns) {
    columns["gnss_" + name] = meaning;
  }
  source.file = files.document.imu.source.file;
  source.columns = std::move(columns);
  source.time.column = "gnss_t";
  for (std::size_t c = 0; c < files.tables.gnss.columns.size(); ++c) {
    std::vector<double> column = files.tables.gnss.columns[c];
    for (std::size_t row = column.size(); row < rows; ++row) {
      column.push_back(missing_sample(Missing::Ended, row + 1));
    }
    files.tables.imu.names.push_back("gnss_" + files.tables.gnss.names[c]);
    files.tables.imu.columns.push_back(std::move(column));
  }
  files.tables.gnss = files.tables.imu;
}

TEST(DriveInput, OneFileOfSeveralStreamsIsTheDriveOfAFileForEach) {
  Files apart = town();
  Files together = town();
  in_one_file(together);
  const auto a = load_drive(apart.document, apart.tables);
  const auto b = load_drive(together.document, together.tables);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->fixes.size(), b->fixes.size());
  for (std::size_t i = 0; i < a->fixes.size(); ++i) {
    EXPECT_EQ(a->fixes[i].time_s, b->fixes[i].time_s);
    EXPECT_EQ(a->fixes[i].position_ecef_m, b->fixes[i].position_ecef_m);
  }
  EXPECT_EQ(a->runs.front().readings, b->runs.front().readings);
  EXPECT_EQ(b->facts.gnss_stamps.rows, a->facts.gnss_stamps.rows);
  EXPECT_EQ(b->facts.gnss_stamps.without_stamp, 0U) << "rows behind the last fix are no rows without a stamp";
}

TEST(DriveInput, ANumberThatStandsForNoneIsARowLeftOutAndNoReading) {
  // -9999 rad/s on one axis for one sample would turn the vehicle by a hundred radians.
  Files gap = town();
  Files sentinel = town();
  gap.imu("gz")[500] = kNothing;
  sentinel.imu("gz")[500] = -9999.0;
  const auto a = load_drive(gap.document, gap.tables);
  const auto b = load_drive(sentinel.document, sentinel.tables);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->runs.front().readings, b->runs.front().readings);
  EXPECT_EQ(b->facts.sampling.incomplete, 1U);
}

/// The rows of the fixes `times` times, as a table at the rate of the unit holds them.
void hold_each(Files& files, std::size_t times) {
  Table held = files.tables.gnss;
  std::for_each(held.columns.begin(), held.columns.end(), [](auto& column) { column.clear(); });
  for (std::size_t row = 0; row < files.tables.gnss.rows(); ++row) {
    for (std::size_t again = 0; again < times; ++again) {
      for (std::size_t c = 0; c < held.columns.size(); ++c) {
        const double value = files.tables.gnss.columns[c][row];
        held.columns[c].push_back(c == 0 ? value + 0.01 * static_cast<double>(again) : value);
      }
    }
  }
  files.tables.gnss = std::move(held);
}

TEST(DriveInput, AFileThatHoldsItsFixesIsTheDriveOfTheFixes) {
  // Each fix five times, at the unit's rate, without a word of it in the document: taken as new data they would count
  // five times, the last 40 ms too late.
  const Files once = town();
  Files held = town();
  hold_each(held, 5);
  const auto a = load_drive(once.document, once.tables);
  const auto b = load_drive(held.document, held.tables);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->fixes.size(), b->fixes.size());
  for (std::size_t i = 0; i < a->fixes.size(); ++i) {
    EXPECT_EQ(a->fixes[i].time_s, b->fixes[i].time_s);
    EXPECT_EQ(a->fixes[i].position_ecef_m, b->fixes[i].position_ecef_m);
  }
  EXPECT_EQ(b->facts.held, 4 * a->fixes.size());
  std::vector<double>& heights = held.gnss("h");
  for (std::size_t row = 0; row < heights.size(); ++row) {
    heights[row] += row % 5 >= 3 ? 0.1 : 0.0;  // stated later than the place, as a car's logger does
  }
  const auto twice = load_drive(held.document, held.tables);
  ASSERT_TRUE(twice);
  EXPECT_EQ(twice->facts.held, b->facts.held) << "a new height is no new place";
  held.gnss("h").assign(held.gnss("h").size(), kNothing);
  const auto flat = load_drive(held.document, held.tables);
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->facts.held, b->facts.held) << "a height that is missing is no new fix";
}

TEST(DriveInput, AReceiverAtRestThatRepeatsItselfHoldsNothing) {
  Files files = town();
  const std::size_t rows = files.tables.gnss.rows();
  for (std::size_t row = 1; row < rows; ++row) {
    const bool still = std::hypot(files.gnss("vn")[row], files.gnss("ve")[row]) < 0.5;
    for (std::size_t c = 1; still && c < files.tables.gnss.columns.size(); ++c) {
      files.tables.gnss.columns[c][row] = files.tables.gnss.columns[c][row - 1];
    }
  }
  const auto drive = load_drive(files.document, files.tables);
  ASSERT_TRUE(drive) << drive.error().message;
  EXPECT_EQ(drive->facts.held, 0U);
  EXPECT_EQ(drive->fixes.size(), rows);
}

TEST(DriveInput, PositionsAloneShowSpeedAndLengthOfTheDrive) {
  // A receiver without velocities was said never to move faster than 3 m/s, over 0 m.
  Files files = town();
  for (const char* name : {"vn", "ve", "vd"}) {
    files.document.gnss.source.columns.erase(name);
  }
  const auto whole = load_drive(town().document, town().tables);
  const auto drive = load_drive(files.document, files.tables);
  ASSERT_TRUE(whole && drive);
  EXPECT_NEAR(drive->facts.length_m, whole->facts.length_m, 0.05 * whole->facts.length_m);
  EXPECT_NEAR(drive->facts.highest_speed_m_s, whole->facts.highest_speed_m_s, 1.0);
}

TEST(DriveInput, AnOdometerIsReadBySpeedOrByTicks) {
  Files files = town();
  OdometerSource& odometer = files.document.odometer.emplace();
  odometer.source.file = "wheel.csv";
  odometer.source.time.column = "t";
  odometer.source.columns = {{"v", {Quantity::OdometerSpeed, "", 1.0 / 3.6}}};
  Table wheel{{"t", "v", "n"}, {{1.0, 1.5, 2.0}, {36.0, 72.0, kNothing}, {0.0, 100.0, 300.0}}, {}, {}};
  files.tables.odometer = wheel;
  const auto by_speed = load_drive(files.document, files.tables);
  ASSERT_TRUE(by_speed) << by_speed.error().message;
  const double zero = by_speed->epoch_s;
  ASSERT_EQ(by_speed->odometer.size(), 2U) << "a row without a number is none";
  EXPECT_NEAR(by_speed->odometer[0].speed_m_s, 10.0, 1e-12);
  EXPECT_NEAR(by_speed->odometer[1].speed_m_s, 20.0, 1e-12);
  EXPECT_NEAR(by_speed->odometer[1].time_s, 1.5 - zero, 1e-9);
  odometer.source.columns = {{"n", {Quantity::OdometerTicks, "", 1.0}}};
  const auto without_length = load_drive(files.document, files.tables);
  ASSERT_FALSE(without_length);
  EXPECT_NE(without_length.error().message.find("metres_per_tick"), std::string::npos);
  odometer.metres_per_tick = 0.02;
  const auto by_ticks = load_drive(files.document, files.tables);
  ASSERT_TRUE(by_ticks);
  ASSERT_EQ(by_ticks->odometer.size(), 2U);
  EXPECT_NEAR(by_ticks->odometer[0].speed_m_s, 0.02 * 100.0 / 0.5, 1e-12);
  EXPECT_NEAR(by_ticks->odometer[0].time_s, 1.25 - zero, 1e-9) << "the mean speed between two counts";
  EXPECT_NEAR(by_ticks->odometer[1].speed_m_s, 0.02 * 200.0 / 0.5, 1e-12);
}

void negate(std::vector<double>& values) {
  std::for_each(values.begin(), values.end(), [](double& value) { value = -value; });
}

struct Case {
  const char* name;
  std::function<void(Files&)> spoil;
  bool refused;
  const char* said;
};

TEST(DriveInput, IsRefusedOrSurvivedWithItsSentence) {
  const std::vector<Case> cases{
      {"nothing", [](Files&) {}, false, "The reference is the withheld fixes"},
      {"latitude and longitude swapped, both plausible", [](Files& f) { std::swap(f.gnss("lat"), f.gnss("lon")); },
       true, "latitude and longitude are swapped"},
      {"up for down", [](Files& f) { f.document.gnss.source.columns["vd"].axis = "up"; }, true,
       "the vertical velocity is up"},
      {"left-handed axes", [](Files& f) { negate(f.imu("gz")); }, true, "left-handed"},
      {"x of the accelerometer mirrored", [](Files& f) { negate(f.imu("ax")); }, true,
       "The accelerometer's x points back where the speed rises"},
      {"y of the accelerometer mirrored", [](Files& f) { negate(f.imu("ay")); }, true,
       "The accelerometer's y points left where the course turns right"},
      {"x and y of the accelerometer exchanged", [](Files& f) { std::swap(f.imu("ax"), f.imu("ay")); }, true,
       "x and y are exchanged"},
      {"radians called degrees",
       [](Files& f) {
         for (const char* name : {"lat", "lon"}) {
           f.document.gnss.source.columns[name].factor = std::numbers::pi / 180.0;
         }
       },
       true, "latitude and longitude are in radians, not degrees"},
      {"a constant accuracy to the north",
       [](Files& f) {
         f.document.gnss.source.columns["sd"] = {Quantity::GnssAccuracy, "north", 1.0};
         f.document.gnss.source.columns["sdv"] = {Quantity::GnssAccuracy, "east", 1.0};
         f.gnss("sdv").assign(f.gnss("sdv").size(), 3.0);
       },
       false, "The stated accuracy of the positions never varies"},
      {"heights of 0 beside the unit's longer stream",
       [](Files& f) {
         f.gnss("h").assign(f.gnss("h").size(), 0.0);
         in_one_file(f);
       },
       false, "Every height is 0"},
      {"heights of 0 but for one that is missing",
       [](Files& f) {
         f.gnss("h").assign(f.gnss("h").size(), 0.0);
         f.gnss("h")[30] = kNothing;
       },
       false, "Every height is 0"},
      {"a constant accuracy beside the unit's longer stream",
       [](Files& f) {
         f.gnss("sdv").assign(f.gnss("sdv").size(), 3.0);
         in_one_file(f);
       },
       false, "The stated vertical accuracy never varies"},
      {"a constant course beside the unit's longer stream",
       [](Files& f) {
         by_course(f);
         f.gnss("ve").assign(f.gnss("ve").size(), 1.0);
         in_one_file(f);
       },
       false, "The course of the fixes never varies"},
      {"a file that is torn, as its decoder says",
       [](Files& f) { f.tables.imu.notes.emplace_back("the last row is torn and left out"); }, false,
       "The file of the readings: the last row is torn and left out"},
      {"a unit that ends before the fixes do",
       [](Files& f) {
         for (auto& column : f.tables.imu.columns) {
           column.resize(column.size() - 1000);
         }
       },
       false, "fixes lie before the first reading of the unit or after its last"},
      {"fixes that end before the unit does",
       [](Files& f) {
         for (auto& column : f.tables.gnss.columns) {
           column.resize(column.size() - 80);
         }
       },
       false, "The fixes end 21 s before the readings do"},
      {"stamps of the unit that repeat", [](Files& f) { f.imu("t")[700] = f.imu("t")[701] = f.imu("t")[699]; }, false,
       "2 rows of the unit have the time of the row before"},
      {"fixes that are held at the unit's rate", [](Files& f) { hold_each(f, 5); }, false,
       "rows of the fixes repeat the fix before"},
      {"fixes without velocities",
       [](Files& f) {
         for (const char* name : {"vn", "ve", "vd"}) {
           f.document.gnss.source.columns.erase(name);
         }
       },
       false, "No fix has a velocity"},
      {"a placeholder before the first fix",
       [](Files& f) { std::fill_n(f.gnss("lat").begin(), 3, std::numbers::pi / 4.0); }, false,
       "3 fixes lie more than 200 km from the middle of the drive"},
      {"a position of 0, 0",
       [](Files& f) {
         std::fill_n(f.gnss("lat").begin(), 2, 0.0);
         std::fill_n(f.gnss("lon").begin(), 2, 0.0);
       },
       false, "2 rows of the fixes have no position"},
      {"fixes of a type that is not to be used",
       [](Files& f) {
         f.document.gnss.fix_types = {1};
         std::fill_n(f.gnss("type").begin() + 50, 7, 5.0);
       },
       false, "7 fixes of other types are left out"},
      {"seconds of the week that start again",
       [](Files& f) {
         for (std::vector<double>* t : {&f.imu("t"), &f.gnss("t")}) {
           std::for_each(t->begin(), t->end(), [](double& s) { s = std::fmod(s + 604700.0, 604800.0); });
         }
         f.document.imu.source.time.scale = f.document.gnss.source.time.scale = TimeScale::Gps;
       },
       false, "The seconds of the week start again within the drive"},
      {"a leap second",
       [](Files& f) {
         for (std::vector<double>* t : {&f.imu("t"), &f.gnss("t")}) {
           std::for_each(t->begin(), t->end(), [](double& s) { s += 1483228800.0 - (s < 200.0 ? 199.0 : 200.0); });
         }
         f.document.imu.source.time.scale = f.document.gnss.source.time.scale = TimeScale::Utc;
       },
       false, "A leap second falls within the drive"},
      {"the filter's own input as reference", [](Files& f) { own_reference(f, 0.0); }, false, "the filter's own input"},
      {"a reference with gaps",
       [](Files& f) {
         own_reference(f, 1e-7);
         std::vector<double>& t = f.tables.reference->columns[0];
         for (double& one : t) {
           one = one > 100.0 && one < 130.0 ? kNothing : one;
         }
       },
       false, "The reference has gaps (1, 30 s in all)"},
      {"an accuracy of 0", [](Files& f) { f.gnss("sd")[40] = f.gnss("sd")[41] = 0.0; }, false,
       "2 fixes state an accuracy that is 0"},
      {"an accuracy that is no number", [](Files& f) { f.gnss("sdv")[40] = kNothing; }, false,
       "1 fixes state an accuracy that is 0 or no number"},
      {"a constant vertical accuracy", [](Files& f) { f.gnss("sdv").assign(f.gnss("sdv").size(), 3.0); }, false,
       "The stated vertical accuracy never varies"},
      {"heights of 0", [](Files& f) { f.gnss("h").assign(f.gnss("h").size(), 0.0); }, false, "Every height is 0"},
      {"a course that is always 0",
       [](Files& f) {
         by_course(f);
         f.gnss("ve").assign(f.gnss("ve").size(), 0.0);
       },
       false, "The course of the fixes never varies"},
      {"a fix type that is lost for a while",
       [](Files& f) {
         f.document.gnss.fix_types = {1};
         std::fill_n(f.gnss("type").begin() + 50, 7, kNothing);
       },
       false, "7 fixes say no type"},
      {"a fix type that no column says",
       [](Files& f) {
         f.document.gnss.fix_types = {1};
         f.document.gnss.source.columns.erase("type");
       },
       true, "no column says the fix_type"},
      {"stamps that step back", [](Files& f) { std::swap(f.imu("t")[700], f.imu("t")[703]); }, false,
       "rows whose stamp steps back"},
      {"a torn first row of the unit", [](Files& f) { f.imu("ay")[0] = f.imu("az")[0] = kNothing; }, false,
       "rows of the unit are incomplete"},
      {"a reading of -9999, which is no measurement", [](Files& f) { f.imu("gz")[500] = f.imu("gz")[501] = -9999.0; },
       false, "'gz': 2 samples are no measurements (such as -9999) and are left out"},
      {"an axis that is frozen for a while", [](Files& f) { std::fill_n(f.imu("ax").begin() + 9000, 900, 0.25); },
       false, "'ax': the sensor is frozen for 900 samples from sample 9001"},
      {"an axis that is all text",
       [](Files& f) {
         for (std::size_t row = 0; row < f.imu("gx").size(); ++row) {
           f.imu("gx")[row] = missing_sample(Missing::Text, row + 1);
         }
       },
       true, "imu.csv: Row 1, column 'gx' holds text"},
      {"a torn row of text", [](Files& f) { f.imu("az").back() = missing_sample(Missing::Text, f.imu("az").size()); },
       false, "rows of the unit are incomplete"},
      {"a first row without its time", [](Files& f) { f.gnss("t")[0] = kNothing; }, false, "rows have no time"},
      {"a torn last row of the fixes", [](Files& f) { f.gnss("lat").back() = kNothing; }, false, "have no position"},
      {"an arm whose uncertainty is stated", [](Files& f) { f.document.gnss.lever_arm_sd_m = 1.0; }, false,
       "The lever arm is taken as stated"},
      {"a mounting whose uncertainty is stated", [](Files& f) { f.document.imu.mounting_sd_rad = 0.02; }, false,
       "The mounting is taken as stated"},
      {"readings stamped on arrival", [](Files& f) { f.document.imu.source.time.arrival = true; }, false,
       "Readings are stamped when they arrive"},
      {"a clock of arrival", [](Files& f) { f.document.imu.clock = SensorClock::Arrival; }, false,
       "Readings are stamped when they arrive"},
      {"fixes stamped on arrival", [](Files& f) { f.document.gnss.source.time.arrival = true; }, false,
       "Fixes are stamped when they arrive"},
  };
  const Files sound = town();
  for (const Case& one : cases) {
    Files files = sound;
    one.spoil(files);
    const auto drive = load_drive(files.document, files.tables);
    std::string said;
    if (drive) {
      for (const std::string& note : drive->facts.notes) {
        said += note + "\n";
      }
    } else {
      said = drive.error().message;
    }
    EXPECT_EQ(!drive, one.refused) << one.name << ": " << said;
    EXPECT_NE(said.find(one.said), std::string::npos) << one.name << ": " << said;
  }
}

TEST(DriveInput, StampsOfArrivalGetEqualSpacing) {
  // Every second reading arrives a millisecond late: taken at their stamps, readings would be mixed with their
  // neighbours on the even grid.
  Files files = town();
  std::vector<double>& t = files.imu("t");
  for (std::size_t i = 0; i < t.size(); i += 2) {
    t[i] += 0.001;
  }
  files.document.imu.source.time.arrival = true;
  const auto drive = load_drive(files.document, files.tables);
  ASSERT_TRUE(drive) << drive.error().message;
  ASSERT_EQ(drive->runs.size(), 1U);
  EXPECT_NEAR(static_cast<double>(drive->runs.front().readings.size()), static_cast<double>(t.size()), 3.0);
  EXPECT_EQ(drive->runs.front().readings[1001][2], files.imu("gz")[1001]) << "each reading is one of the file";
}

TEST(DriveInput, StampsOfArrivalGetEqualSpacingBesideAGapThatIsBridged) {
  // Every second reading arrives a millisecond late, but for the first, and one of the late ones is lost. Taken at
  // their stamps, readings would be mixed with their neighbours by a tenth of the difference.
  Files files = town();
  std::vector<double>& t = files.imu("t");
  for (std::size_t i = 2; i < t.size(); i += 2) {
    t[i] += 0.001;
  }
  const std::size_t lost = 20000;
  files.imu("gz")[lost] = kNothing;
  files.document.imu.source.time.arrival = true;
  const auto drive = load_drive(files.document, files.tables);
  ASSERT_TRUE(drive) << drive.error().message;
  ASSERT_EQ(drive->runs.size(), 1U);
  EXPECT_EQ(drive->facts.sampling.samples_bridged, 1U);
  const std::vector<ImuSample>& readings = drive->runs.front().readings;
  ASSERT_EQ(readings.size(), t.size());
  double mixed = 0.0;
  double changes = 0.0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const bool near = i >= lost - 2 && i <= lost + 2;
    mixed += near ? 0.0 : std::abs(readings[i][2] - files.imu("gz")[i]);
    changes += near ? 0.0 : std::abs(files.imu("gz")[i] - files.imu("gz")[i - 1]);
  }
  EXPECT_LT(mixed, 1e-3 * changes);
}

TEST(DriveInput, SpeedAndCourseOfZeroIsRestAndNoHeading) {
  Files files = town();
  by_course(files);
  const auto drive = load_drive(files.document, files.tables);
  ASSERT_TRUE(drive) << drive.error().message;
  std::size_t resting = 0;
  for (const Fix& fix : drive->fixes) {
    ASSERT_TRUE(fix.velocity_ned_m_s);
    if (fix.velocity_ned_m_s->head<2>().norm() == 0.0) {
      ++resting;
      EXPECT_FALSE(fix.has_course);
      EXPECT_GE(fix.velocity_sd_m_s.x(), 0.5);
    }
  }
  EXPECT_GT(resting, 50U);
}

}  // namespace
}  // namespace driftlab::drive
