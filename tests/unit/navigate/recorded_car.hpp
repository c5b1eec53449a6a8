#pragma once
/// The shared recording rtk-car-0708 as `load_drive` gives it: the README's mounting, an arm of 0 +- 1 m, no offsets,
/// the data sheet's noise (the document that tests/api/drive_documents.py writes).
#include "core/navigate/drive/drive.hpp"
#include "core/process/registry.hpp"
#include "core/read/column_file.hpp"
#include "core/read/format.hpp"
#include "core/read/rtklib_tag.hpp"
#include "core/signal/angle.hpp"
#include "tests/shared_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <optional>

namespace driftlab::drive {

inline Table decoded_table(const std::filesystem::path& file) {
  const std::filesystem::path columns_file =
      std::filesystem::temp_directory_path() / ("driftlab-car-" + file.filename().string());
  Table table;
  const auto decoded = decode_file(file, columns_file);
  EXPECT_TRUE(decoded) << decoded.error().message;
  if (const auto columns = ColumnFile::open(columns_file)) {
    table.names = columns->names();
    for (std::size_t i = 0; i < table.names.size(); ++i) {
      const auto values = columns->column(i);
      table.columns.emplace_back(values.begin(), values.end());
    }
  }
  std::filesystem::remove(columns_file);
  return table;
}

inline Document car_document() {
  Document document;
  document.id = "rtk-car-0708";
  const std::array<std::string, 3> axes{"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    document.imu.source.columns[std::to_string(i)] = {Quantity::SpecificForce, axes[i], 9.80665};
    document.imu.source.columns[std::to_string(3 + i)] = {Quantity::AngularRate, axes[i], kDegree};
    document.model.axes[i].bias_sd = 0.5 * kDegree;
    document.model.axes[i].processes = ModelSchedule::constant(
        {*make_process("white_noise", {0.0038 * kDegree}), *make_process("random_walk", {2e-4 * kDegree})});
    document.model.axes[3 + i].bias_sd = 0.020 * 9.80665;
    document.model.axes[3 + i].processes = ModelSchedule::constant(
        {*make_process("white_noise", {70e-6 * 9.80665}), *make_process("random_walk", {2e-4})});
  }
  document.imu.source.time.column = "6";
  document.imu.source.time.unit_s = 1e-3;
  document.imu.clock = SensorClock::Host;
  document.imu.mounting = {180.0 * kDegree, -6.79 * kDegree, 185.35 * kDegree};
  document.gnss.source.time.column = "time (s)";
  document.gnss.source.time.scale = TimeScale::Gps;
  document.gnss.source.columns = {{"latitude(deg)", {Quantity::GnssPosition, "lat", kDegree}},
                                  {"longitude(deg)", {Quantity::GnssPosition, "lon", kDegree}},
                                  {"height(m)", {Quantity::GnssPosition, "height", 1.0}},
                                  {"vn(m/s)", {Quantity::GnssVelocity, "north", 1.0}},
                                  {"ve(m/s)", {Quantity::GnssVelocity, "east", 1.0}},
                                  {"vu(m/s)", {Quantity::GnssVelocity, "up", 1.0}},
                                  {"sdn(m)", {Quantity::GnssAccuracy, "north", 1.0}},
                                  {"sde(m)", {Quantity::GnssAccuracy, "east", 1.0}},
                                  {"sdu(m)", {Quantity::GnssAccuracy, "down", 1.0}},
                                  {"sdvn", {Quantity::GnssAccuracy, "speed", 1.0}},
                                  {"Q", {Quantity::FixType, "", 1.0}}};
  document.gnss.fix_types = {1, 2};
  document.gnss.lever_arm_sd_m = 1.0;
  return document;
}

/// Nothing where the shared folder does not hold it.
inline std::optional<Drive> recorded_car() {
  const auto shared = shared_folder("data/drives/rtk-car-0708");
  if (!shared) {
    return std::nullopt;
  }
  const std::filesystem::path folder = *shared / "data/drives/rtk-car-0708";
  Tables tables;
  tables.imu = decoded_table(folder / "imu_1934.csv.xz");
  const auto tag = read_rtklib_tag(folder / "imu_1934.csv.tag.xz");
  EXPECT_TRUE(tag) << tag.error().message;
  if (tag) {
    tables.imu.tag = TimeTag{tag->first_s, tag->last_s};
  }
  tables.gnss = decoded_table(folder / "gnss_1934_sf.pos.xz");
  auto drive = load_drive(car_document(), tables);
  EXPECT_TRUE(drive) << drive.error().message;
  return drive ? std::optional(std::move(*drive)) : std::nullopt;
}

}  // namespace driftlab::drive
