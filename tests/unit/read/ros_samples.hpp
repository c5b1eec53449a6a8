#pragma once
/// The table of inertial_samples.hpp as messages of ROS, and the files that hold such.
#include "tests/unit/read/inertial_samples.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <sqlite3.h>
#include <zlib.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::testing {

// --- ROS: sensor_msgs/Imu, and the files that hold its messages ---

/// The numbers of a message: the orientation is left at zero; a covariance that begins with -1 says "not measured".
inline std::string imu_numbers(const InertialRow& row, double gyro_covariance = 0.0, double accel_covariance = 0.0) {
  const std::string rest(8 * sizeof(double), '\0');
  return std::string(13 * sizeof(double), '\0') + triad_bytes<double>(row.gyro_rad_s) + bytes_of(gyro_covariance) +
         rest + triad_bytes<double>(row.accel_m_s2) + bytes_of(accel_covariance) + rest;
}

inline std::string ros_stamp(std::uint64_t time_us) {
  return word(time_us / 1'000'000, 4) + word(time_us % 1'000'000 * 1000, 4);
}

inline std::string ros1_imu(const InertialRow& row, const std::string& numbers) {
  return word(7, 4) + ros_stamp(row.time_us) + word(3, 4) + "imu" + numbers;
}
inline std::string ros1_imu(const InertialRow& row) { return ros1_imu(row, imu_numbers(row)); }

/// With an encapsulation of little-endian CDR; `frame` with its final zero decides on the padding.
inline std::string cdr_imu(const InertialRow& row, const std::string& frame = "imu") {
  std::string body = ros_stamp(row.time_us) + word(frame.size() + 1, 4) + frame + '\0';
  body.resize((body.size() + 7) / 8 * 8);
  return std::string("\0\1\0\0", 4) + body + imu_numbers(row);
}

/// A satellite fix and a moment of an odometer. Standard deviations are powers of two, so that their squares are exact.
struct FixRow {
  std::uint64_t time_us = 0;
  double latitude_deg = 50.5;
  double longitude_deg = 13.25;
  double height_m = 250.0;
};
struct OdometryRow {
  std::uint64_t time_us = 0;
  double speed_m_s = 4.0;
};

inline std::string numbers_of(const std::vector<double>& values) {
  std::string bytes;
  for (const double value : values) {
    bytes += bytes_of(value);
  }
  return bytes;
}

/// sensor_msgs/NavSatFix behind its header: east 0.5, north 0.25, up 2 m, of covariance type `type`.
inline std::string fix_numbers(const FixRow& row, unsigned type) {
  return numbers_of({row.latitude_deg, row.longitude_deg, row.height_m, 0.25, 0, 0, 0, 0.0625, 0, 0, 0, 4.0}) +
         word(type, 1);
}

inline std::string ros1_fix(const FixRow& row, unsigned type = 2) {
  return word(9, 4) + ros_stamp(row.time_us) + word(3, 4) + "gps" + word(1, 1) + word(1, 2) + fix_numbers(row, type);
}

inline std::string cdr_padded(std::string body, std::size_t alignment) {
  body.resize((body.size() + alignment - 1) / alignment * alignment);
  return body;
}

inline std::string cdr_fix(const FixRow& row, unsigned type = 2) {
  std::string body = ros_stamp(row.time_us) + word(4, 4) + "gps" + '\0' + word(1, 1);
  body = cdr_padded(cdr_padded(std::move(body), 2) + word(1, 2), 8);
  return std::string("\0\1\0\0", 4) + body + fix_numbers(row, type);
}

/// nav_msgs/Odometry behind its frames.
inline std::string odometry_numbers(const OdometryRow& row) {
  std::vector<double> values(3 + 4 + 36 + 6 + 36);
  values[0] = 2.0 * row.speed_m_s;
  values[3 + 4 + 36] = row.speed_m_s;
  values[3 + 4 + 36 + 5] = -0.125;
  return numbers_of(values);
}

inline std::string ros1_odometry(const OdometryRow& row) {
  return word(9, 4) + ros_stamp(row.time_us) + word(4, 4) + "odom" + word(9, 4) + "base_link" + odometry_numbers(row);
}

inline std::string cdr_odometry(const OdometryRow& row) {
  std::string body =
      cdr_padded(ros_stamp(row.time_us) + word(5, 4) + "odom" + '\0', 4) + word(10, 4) + "base_link" + '\0';
  return std::string("\0\1\0\0", 4) + cdr_padded(std::move(body), 8) + odometry_numbers(row);
}

/// `plain` as libarchive packs it: bzip2, an LZ4 frame or zstd.
inline std::string packed(std::string_view plain, int filter) {
  std::string bytes(2 * plain.size() + 4096, '\0');
  std::size_t used = 0;
  archive* const writer = archive_write_new();
  archive_write_add_filter(writer, filter);
  archive_write_set_format_raw(writer);
  archive_write_set_bytes_per_block(writer, 1);
  archive_write_open_memory(writer, bytes.data(), bytes.size(), &used);
  archive_entry* const entry = archive_entry_new();
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_write_header(writer, entry);
  archive_write_data(writer, plain.data(), plain.size());
  archive_entry_free(entry);
  archive_write_close(writer);
  archive_write_free(writer);
  bytes.resize(used);
  return bytes;
}

inline std::string packed_as(const std::string& compression, std::string_view plain) {
  if (compression == "bz2") {
    return packed(plain, ARCHIVE_FILTER_BZIP2);
  }
  if (compression == "lz4") {
    return packed(plain, ARCHIVE_FILTER_LZ4);
  }
  return compression == "zstd" ? packed(plain, ARCHIVE_FILTER_ZSTD) : std::string(plain);
}

inline std::string text_with_size(const std::string& text) { return word(text.size(), 4) + text; }

// --- ROS 1 bag ---

inline std::string bag_record(const std::vector<std::string>& fields, const std::string& data) {
  std::string header;
  for (const std::string& field : fields) {
    header += text_with_size(field);
  }
  return text_with_size(header) + text_with_size(data);
}

inline std::string bag_front(std::uint64_t index_position = 4117) {
  return "#ROSBAG V2.0\n" + bag_record({"op=\x03", "index_pos=" + word(index_position, 8)}, "   ");
}

inline std::string bag_connection(unsigned id, const std::string& topic, const std::string& type) {
  return bag_record({"op=\x07", "conn=" + word(id, 4), "topic=" + topic},
                    text_with_size("topic=" + topic) + text_with_size("type=" + type));
}

inline std::string bag_message(unsigned id, std::uint64_t time_us, const std::string& data) {
  return bag_record({"op=\x02", "conn=" + word(id, 4), "time=" + ros_stamp(time_us)}, data);
}

inline std::string bag_chunk(const std::string& compression, const std::string& records) {
  return bag_record({"op=\x05", "compression=" + compression, "size=" + word(records.size(), 4)},
                    packed_as(compression, records));
}

inline std::string rosbag(const std::vector<InertialRow>& rows, const std::string& compression = "none") {
  std::string records = bag_connection(0, "/imu", "sensor_msgs/Imu");
  for (const InertialRow& row : rows) {
    records += bag_message(0, row.time_us + 150, ros1_imu(row));
  }
  return bag_front() + bag_chunk(compression, records) + bag_record({"op=\x04"}, "index") +
         bag_connection(0, "/imu", "sensor_msgs/Imu");
}

// --- MCAP ---

inline std::string mcap_record(int letter, const std::string& body) {
  return word(static_cast<unsigned>(letter), 1) + word(body.size(), 8) + body;
}

inline const std::string kMcapMagic = "\x89MCAP0\r\n";

inline std::string mcap_channel(unsigned id, const std::string& topic, const std::string& type,
                                const std::string& encoding) {
  return mcap_record(3, word(id + 1, 2) + text_with_size(type) + text_with_size("ros2msg") + text_with_size("...")) +
         mcap_record(4, word(id, 2) + word(id + 1, 2) + text_with_size(topic) + text_with_size(encoding) + word(0, 4));
}

inline std::string mcap_message(unsigned id, std::uint64_t log_us, const std::string& data) {
  return mcap_record(5, word(id, 2) + word(1, 4) + word(log_us * 1000, 8) + word(log_us * 1000, 8) + data);
}

/// `checksum`: 0 states none.
inline std::string mcap_chunk(const std::string& compression, const std::string& records, std::uint32_t checksum) {
  const std::string data = packed_as(compression, records);
  return mcap_record(6, word(0, 8) + word(0, 8) + word(records.size(), 8) + word(checksum, 4) +
                            text_with_size(compression) + word(data.size(), 8) + data);
}

inline std::uint32_t crc_of(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

/// The file of `records` in one chunk, closed by a footer.
inline std::string mcap_file(const std::string& compression, const std::string& records) {
  return kMcapMagic + mcap_record(1, text_with_size("") + text_with_size("by hand")) +
         mcap_chunk(compression, records, crc_of(records)) + mcap_record(15, word(0, 4)) +
         mcap_record(2, word(0, 8) + word(0, 8) + word(0, 4)) + kMcapMagic;
}

/// Messages in the encoding `cdr` or `ros1`.
inline std::string mcap(const std::vector<InertialRow>& rows, const std::string& compression = "",
                        const std::string& encoding = "cdr") {
  std::string records =
      mcap_channel(0, "/imu", encoding == "cdr" ? "sensor_msgs/msg/Imu" : "sensor_msgs/Imu", encoding);
  for (const InertialRow& row : rows) {
    records += mcap_message(0, row.time_us + 150, encoding == "cdr" ? cdr_imu(row) : ros1_imu(row));
  }
  return mcap_file(compression, records);
}

// --- ROS 2 bag in SQLite ---

/// A database that `sql` makes, in pages of 512 bytes.
inline std::string database(const std::string& sql) {
  sqlite3* handle = nullptr;
  sqlite3_open(":memory:", &handle);
  sqlite3_exec(handle, ("PRAGMA page_size=512;" + sql).c_str(), nullptr, nullptr, nullptr);
  sqlite3_int64 size = 0;
  unsigned char* const bytes = sqlite3_serialize(handle, "main", &size, 0);
  std::string file(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  sqlite3_free(bytes);
  sqlite3_close(handle);
  return file;
}

inline std::string sql_blob(const std::string& bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "x'";
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += {kDigits[byte >> 4U], kDigits[byte & 15U]};
  }
  return text + "'";
}

inline const std::string kBag2Tables =
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);"
    "INSERT INTO topics VALUES(1,'/log','rcl_interfaces/msg/Log','cdr'),(2,'/imu','sensor_msgs/msg/Imu','cdr');";

inline std::string bag2_message(int topic, std::uint64_t time_us, const std::string& data) {
  return "INSERT INTO messages(topic_id,timestamp,data) VALUES(" + std::to_string(topic) + "," +
         std::to_string(time_us * 1000) + "," + sql_blob(data) + ");";
}

inline std::string rosbag2(const std::vector<InertialRow>& rows) {
  std::string sql = kBag2Tables + bag2_message(1, 1, "no inertial message");
  for (const InertialRow& row : rows) {
    sql += bag2_message(2, row.time_us, cdr_imu(row));
  }
  return database(sql);
}

}  // namespace driftlab::testing
