#pragma once
/// Logs of a journey: the table of inertial_samples.hpp with fixes and an odometer beside it.
#include "tests/unit/read/ros_samples.hpp"

namespace driftlab::testing {

inline constexpr std::uint64_t kStart = 1'700'000'000'000'000U;

/// Forty rows of 5 ms; fixes from 20 ms before them on, each 100 ms; an odometer each 50 ms.
inline const std::vector<FixRow>& fixes() {
  static const std::vector<FixRow> rows{{kStart - 20'000}, {kStart + 80'000, 50.75, 13.5, 251.0}};
  return rows;
}
inline const std::vector<OdometryRow>& odometry() {
  static const std::vector<OdometryRow> rows{{kStart, 1.0}, {kStart + 50'000, 2.0}, {kStart + 100'000, 3.0}};
  return rows;
}

inline std::string journey_bag(std::size_t rows = 40) {
  std::string records = bag_connection(0, "/imu", "sensor_msgs/Imu") +
                        bag_connection(1, "/fix", "sensor_msgs/NavSatFix") +
                        bag_connection(2, "/odom", "nav_msgs/Odometry");
  for (const FixRow& row : fixes()) {
    records += bag_message(1, row.time_us, ros1_fix(row));
  }
  for (const InertialRow& row : inertial_rows(rows)) {
    records += bag_message(0, row.time_us, ros1_imu(row));
  }
  for (const OdometryRow& row : odometry()) {
    records += bag_message(2, row.time_us, ros1_odometry(row));
  }
  return bag_front() + bag_chunk("lz4", records);
}

inline std::string journey_mcap(std::size_t rows = 40) {
  std::string records = mcap_channel(0, "/imu", "sensor_msgs/msg/Imu", "cdr") +
                        mcap_channel(2, "/fix", "sensor_msgs/msg/NavSatFix", "cdr") +
                        mcap_channel(4, "/odom", "nav_msgs/msg/Odometry", "cdr");
  for (const FixRow& row : fixes()) {
    records += mcap_message(2, row.time_us, cdr_fix(row));
  }
  for (const InertialRow& row : inertial_rows(rows)) {
    records += mcap_message(0, row.time_us, cdr_imu(row));
  }
  for (const OdometryRow& row : odometry()) {
    records += mcap_message(4, row.time_us, cdr_odometry(row));
  }
  return mcap_file("zstd", records);
}

inline std::string journey_bag2(std::size_t rows = 40) {
  std::string sql = kBag2Tables +
                    "INSERT INTO topics VALUES(3,'/fix','sensor_msgs/msg/NavSatFix','cdr'),"
                    "(4,'/odom','nav_msgs/msg/Odometry','cdr');";
  for (const FixRow& row : fixes()) {
    sql += bag2_message(3, row.time_us, cdr_fix(row));
  }
  for (const InertialRow& row : inertial_rows(rows)) {
    sql += bag2_message(2, row.time_us, cdr_imu(row));
  }
  for (const OdometryRow& row : odometry()) {
    sql += bag2_message(4, row.time_us, cdr_odometry(row));
  }
  return database(sql);
}

inline const std::string kOldFix =
    "vehicle_gps_position:uint64_t timestamp;uint64_t time_utc_usec;int32_t lat;int32_t lon;int32_t alt;"
    "int32_t alt_ellipsoid;float s_variance_m_s;float eph;float epv;float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;"
    "uint8_t fix_type;uint8_t satellites_used;";
inline const std::string kNewFix =
    "sensor_gps:uint64_t timestamp;uint64_t timestamp_sample;double latitude_deg;double longitude_deg;"
    "double altitude_msl_m;double altitude_ellipsoid_m;uint64_t time_utc_usec;float s_variance_m_s;float eph;float epv;"
    "float vel_n_m_s;float vel_e_m_s;float vel_d_m_s;uint8_t fix_type;uint8_t satellites_used;";

inline std::string floats(const std::vector<float>& values) {
  std::string bytes;
  for (const float value : values) {
    bytes += bytes_of(value);
  }
  return bytes;
}

/// sensor_combined with a fix of the older layout of PX4.
inline std::string ulog_with_fixes() {
  std::string file = ulog_front() + ulog_topic(kSensorCombined) + ulog_topic(kOldFix, 8);
  for (const InertialRow& row : inertial_rows(2)) {
    file += ulog_sample(row);
    file += ulog_message('D', word(8, 2) + word(row.time_us, 8) + std::string(24, '\1') +
                                  floats({0.25F, 0.5F, 0.75F, 1.5F, -2.5F, 0.125F}) + word(3, 1) + word(11, 1));
  }
  return file;
}

/// A GPS message of ArduPilot and its sample.
inline std::string dataflash_gps() {
  return dataflash_format(9, 8 + 1 + 1 + 4 + 2 + 1 + 2 + 4 + 4 + 4 + 4 + 4 + 4, "GPS", "QBBIHBcLLefff",
                          "TimeUS,I,Status,GMS,GWk,NSats,HDop,Lat,Lng,Alt,Spd,GCrs,VZ");
}
inline std::string dataflash_fix(std::uint64_t time_us, unsigned receiver) {
  return dataflash_message(9, word(time_us, 8) + word(receiver, 1) + word(3, 1) + word(345'600'200, 4) + word(2270, 2) +
                                  word(12, 1) + word(85, 2) + bytes_of(std::int32_t{-353'632'621}) +
                                  bytes_of(std::int32_t{1'491'652'300}) + bytes_of(std::int32_t{58'412}) +
                                  floats({12.5F, 271.25F, -0.5F}));
}
inline std::string dataflash_with_fixes() {
  std::string file = dataflash_front() + dataflash_gps();
  for (const InertialRow& row : inertial_rows(2)) {
    file += dataflash_sample(row) + dataflash_fix(row.time_us + 250, 0);
  }
  return file;
}

}  // namespace driftlab::testing
