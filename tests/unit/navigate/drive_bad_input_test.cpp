// Bad input of drives: each is refused with its sentence, or survived with one among the notes (spec/drives.md, 8).
#include "tests/unit/navigate/drive_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>

namespace driftlab::drive {
namespace {

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

}  // namespace
}  // namespace driftlab::drive
