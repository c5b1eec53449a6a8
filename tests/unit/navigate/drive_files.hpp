#pragma once
/// A simulated drive as its files would hold it, and ways in which files differ that say the same.
#include "core/signal/missing.hpp"
#include "tests/unit/navigate/drive_fixture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::drive {

inline constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

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
inline Files town() {
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
inline void by_course(Files& files) {
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

/// The fixes in columns beside the unit's rows, as a flight log or a bag gives them.
inline void in_one_file(Files& files) {
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

/// The rows of the fixes `times` times, as a table at the rate of the unit holds them.
inline void hold_each(Files& files, std::size_t times) {
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

}  // namespace driftlab::drive
