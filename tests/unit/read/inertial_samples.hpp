#pragma once
/// One table of inertial samples, written in every format that holds such: whatever the format, it reads the same.
#include "tests/unit/read/archives.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::testing {

/// A row on the clock of a sensor. Values are exact in a float, times in whole microseconds.
struct InertialRow {
  std::uint64_t time_us = 0;
  std::array<double, 3> gyro_rad_s{};
  std::array<double, 3> accel_m_s2{};
};

/// Steps of 5 ms, once 10 ms.
inline std::vector<InertialRow> inertial_rows(std::size_t count = 4) {
  std::vector<InertialRow> rows;
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<double>(i % 1000);
    const std::uint64_t time = 1'700'000'000'000'000U + 5000 * i + (i > 2 ? 5000 : 0);
    rows.push_back({time, {0.125 * k, -0.5, 0.0078125 * k}, {0.25, -0.75 * k, 9.8125}});
  }
  return rows;
}

/// The bytes of a number as this machine, a little-endian one, keeps them.
template <class Number>
std::string bytes_of(Number value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

template <class Number>
std::string triad_bytes(const std::array<double, 3>& values) {
  std::string bytes;
  for (const double value : values) {
    bytes += bytes_of(static_cast<Number>(value));
  }
  return bytes;
}

// --- PX4 ULog ---

inline std::string ulog_message(char letter, const std::string& body) { return word(body.size(), 2) + letter + body; }

/// The front of a log: header and flags (a bit set of features, offsets of appended data).
inline std::string ulog_front(char must_know = '\0', std::uint64_t appended = 0) {
  return std::string("ULog\x01\x12\x35\x01", 8) + word(1000, 8) +
         ulog_message(
             'B', std::string(8, '\0') + must_know + std::string(7, '\0') + word(appended, 8) + std::string(16, '\0'));
}

inline constexpr std::string_view kSensorCombined =
    "sensor_combined:uint64_t timestamp;pair before;float[3] gyro_rad;float[3] accelerometer_m_s2;";

/// Declares `pair` and what `definition` says, and subscribes to it as message 3.
inline std::string ulog_topic(std::string_view definition, int id = 3, int instance = 0) {
  const std::string name(definition.substr(0, definition.find(':')));
  return ulog_message('F', "pair:uint8_t[2] a;uint16_t b;") + ulog_message('F', std::string(definition)) +
         ulog_message('A', word(static_cast<unsigned>(instance), 1) + word(static_cast<unsigned>(id), 2) + name);
}

inline std::string ulog_sample(const InertialRow& row, int id = 3) {
  return ulog_message('D', word(static_cast<unsigned>(id), 2) + word(row.time_us, 8) + word(0, 4) +
                               triad_bytes<float>(row.gyro_rad_s) + triad_bytes<float>(row.accel_m_s2));
}

inline std::string ulog_sync() { return ulog_message('S', std::string("\x2F\x73\x13\x20\x25\x0C\xBB\x12", 8)); }

inline std::string ulog(const std::vector<InertialRow>& rows) {
  std::string file = ulog_front() + ulog_topic(kSensorCombined);
  for (const InertialRow& row : rows) {
    file += ulog_sample(row);
  }
  return file + ulog_sync() + ulog_message('O', word(30, 2));
}

// --- ArduPilot DataFlash ---

inline std::string padded(std::string text, std::size_t size) {
  text.resize(size);
  return text;
}

inline std::string dataflash_message(int number, const std::string& body) {
  return "\xA3\x95" + word(static_cast<unsigned>(number), 1) + body;
}

/// FMT: the message `number` of `body_bytes` behind its head.
inline std::string dataflash_format(int number, std::size_t body_bytes, const std::string& name,
                                    const std::string& letters, const std::string& labels) {
  return dataflash_message(128, word(static_cast<unsigned>(number), 1) + word(body_bytes + 3, 1) + padded(name, 4) +
                                    padded(letters, 16) + padded(labels, 64));
}

inline std::string dataflash_sample(const InertialRow& row, int instance = 0) {
  return dataflash_message(7, word(row.time_us, 8) + word(static_cast<unsigned>(instance), 1) +
                                  triad_bytes<float>(row.gyro_rad_s) + triad_bytes<float>(row.accel_m_s2));
}

inline std::string dataflash_front() {
  return dataflash_format(128, 86, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns") +
         dataflash_format(7, 33, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ");
}

inline std::string dataflash(const std::vector<InertialRow>& rows) {
  std::string file = dataflash_front();
  for (const InertialRow& row : rows) {
    file += dataflash_sample(row);
  }
  return file;
}

// --- wearables ---

/// What a block of an AX3 or AX6 says of itself.
struct CwaBlock {
  std::uint32_t sequence = 0;
  std::uint32_t second = 0;    ///< of 2023-05-09 10:11
  std::uint16_t fraction = 0;  ///< of a second, in 1/32768, with the top bit set; 0 for none
  int offset = 0;
  unsigned shape = 0x62;     ///< axes and packing
  unsigned scales = 0x7400;  ///< 1/2048 g, 250 deg/s
};

/// A block of 100 Hz around the samples in `data`; its temperature is 25 degC.
inline std::string cwa_block(const CwaBlock& block, std::size_t samples, const std::string& data) {
  const std::uint32_t date = 23U << 26U | 5U << 22U | 9U << 17U | 10U << 12U | 11U << 6U | block.second;
  std::string bytes = std::string("AX\xfc\x01") + word(block.fraction, 2) + word(0, 4) + word(block.sequence, 4) +
                      word(date, 4) + word(block.scales, 2) + word(256, 2) + word(0, 2) + word(10, 1) +
                      word(block.shape, 1) + word(static_cast<std::uint16_t>(block.offset), 2) + word(samples, 2) +
                      padded(data, 480);
  std::uint16_t sum = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    sum = static_cast<std::uint16_t>(sum + static_cast<unsigned char>(bytes[i]) +
                                     256 * static_cast<unsigned char>(bytes[i + 1]));
  }
  return bytes + word(static_cast<std::uint16_t>(-sum), 2);
}

inline std::string words_of(const std::vector<int>& values) {
  std::string bytes;
  for (const int value : values) {
    bytes += word(static_cast<std::uint16_t>(value), 2);
  }
  return bytes;
}

inline std::string cwa_header() { return padded("MD\xfc\x03", 1024); }

inline std::string cwa() {
  return cwa_header() + cwa_block({0, 7}, 2, words_of({1, 2, 3, 0, 0, 2048, 1, 2, 3, 1024, 0, -2048})) +
         cwa_block({1, 8}, 1, words_of({4, 5, 6, 0, 0, 2048}));
}

/// A page of the samples in `digits`, twelve each.
inline std::string geneactiv_page(int number, const std::string& time, const std::string& digits) {
  return "Recorded Data\r\nDevice Unique Serial Code:012345\r\nSequence Number:" + std::to_string(number) +
         "\r\nPage Time:" + time + "\r\nUnassigned:\r\nTemperature:21.5\r\nBattery voltage:4.1\r\n" +
         "Device Status:Recording\r\nMeasurement Frequency:100.0\r\n" + digits + "\r\n";
}

inline std::string geneactiv_header() {
  return "Device Identity\r\nDevice Unique Serial Code:012345\r\n\r\nCalibration Data\r\nx gain:25600\r\nx offset:0\r\n"
         "y gain:25600\r\ny offset:12800\r\nz gain:-25600\r\nz offset:0\r\nVolts:300\r\nLux:911\r\n\r\n";
}

inline std::string geneactiv() {
  return geneactiv_header() +
         geneactiv_page(0, "2023-05-09 10:11:12:500",
                        "100080F00000"
                        "F00080100000") +
         geneactiv_page(1, "2023-05-09 10:11:12:520", "100080F00000");
}

// --- text ---

/// `separator` before each value, with all its digits.
inline std::string cells_of(const std::array<double, 3>& values, const char* separator, double scale = 1.0) {
  std::string text;
  for (const double value : values) {
    std::array<char, 32> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%s%.17g", separator, scale * value);
    text += buffer.data();
  }
  return text;
}

inline std::string euroc(const std::vector<InertialRow>& rows) {
  std::string text =
      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2],"
      "a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\r\n";
  for (const InertialRow& row : rows) {
    text +=
        std::to_string(row.time_us) + "000" + cells_of(row.gyro_rad_s, ",") + cells_of(row.accel_m_s2, ",") + "\r\n";
  }
  return text;
}

inline const std::string kEchoHeader =
    "%time,field.header.seq,field.header.stamp,field.header.frame_id,field.angular_velocity.x,field.angular_velocity.y,"
    "field.angular_velocity.z,field.linear_acceleration.x,field.linear_acceleration.y,field.linear_acceleration.z\n";

inline std::string rostopic(const std::vector<InertialRow>& rows) {
  std::string text = kEchoHeader;
  for (const InertialRow& row : rows) {
    text += std::to_string(row.time_us + 150) + "000,7," + std::to_string(row.time_us) + "000,imu" +
            cells_of(row.gyro_rad_s, ",") + cells_of(row.accel_m_s2, ",") + "\n";
  }
  return text;
}

/// Increments over steps of 1/64 s, which a double holds exactly.
inline std::string kf_gins(const std::vector<InertialRow>& rows) {
  std::string text;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::array<char, 32> stamp{};
    std::snprintf(stamp.data(), stamp.size(), "%.6f", 456'000.0 + static_cast<double>(i) / 64.0);
    text += stamp.data() + cells_of(rows[i].gyro_rad_s, " ", 1.0 / 64.0) +
            cells_of({0.125, -0.25, 9.8125}, " ", 1.0 / 64.0) + "\n";
  }
  return text;
}

/// A sentence with its checksum.
inline std::string nmea_sentence(const std::string& body) {
  unsigned sum = 0;
  for (const char c : body) {
    sum ^= static_cast<unsigned char>(c);
  }
  std::array<char, 8> tail{};
  std::snprintf(tail.data(), tail.size(), "*%02X\r\n", sum);
  return "$" + body + tail.data();
}

/// Two seconds about midnight; the second position lies west and south.
inline std::string nmea() {
  return nmea_sentence("GPGGA,235959.00,4830.0000,N,00915.0000,E,4,12,0.9,250.5,M,49.5,M,,") +
         nmea_sentence("GPRMC,235959.00,A,4830.0000,N,00915.0000,E,10.0,90.5,311222,,,A") +
         nmea_sentence("GPGST,235959.00,,,,,0.011,0.012,0.021") + nmea_sentence("GPGSV,1,1,00") +
         nmea_sentence("GNGGA,000000.00,4830.0000,S,00915.0000,W,1,11,1.0,251.5,M,49.5,M,,");
}

/// A frame of a u-blox receiver with its checksum.
inline std::string ubx_frame(char of_class, char number, const std::string& payload) {
  std::string inner{of_class, number, static_cast<char>(payload.size() & 255U),
                    static_cast<char>(payload.size() >> 8U)};
  inner += payload;
  unsigned a = 0;
  unsigned b = 0;
  for (const char c : inner) {
    a = (a + static_cast<unsigned char>(c)) & 255U;
    b = (b + a) & 255U;
  }
  return "\xB5\x62" + inner + std::string{static_cast<char>(a), static_cast<char>(b)};
}

/// NAV-PVT of 2025-07-08 19:34:00 UTC (GPS week 2374), a second apart, between words of another protocol.
inline std::string ubx_pvt(int count) {
  std::string log = "$GPTXT,01,01,02,u-blox*00\r\n";
  for (int i = 0; i < count; ++i) {
    std::string p(92, '\0');
    const auto put = [&](std::size_t at, std::int64_t value, std::size_t bytes) {
      for (std::size_t k = 0; k < bytes; ++k) {
        p[at + k] = static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * k) & 255U);
      }
    };
    put(0, 243258000 + 1000 * i, 4);  // 18 leap seconds ahead of UTC
    put(4, 2025, 2);
    put(6, 7, 1);
    put(7, 8, 1);
    put(8, 19, 1);
    put(9, 34, 1);
    put(10, i, 1);
    put(11, 7, 1);
    put(20, 3, 1);
    put(23, 14, 1);
    put(24, 92500000, 4);
    put(28, -485000000, 4);
    put(32, 300125, 4);
    put(36, 250125, 4);
    put(40, 1500, 4);
    put(48, -1250, 4);
    put(64, 9000000, 4);
    put(68, 250, 4);
    log += ubx_frame(1, 7, p) + ubx_frame(1, 3, std::string(16, '\x05'));
  }
  return log;
}

/// Three positions 0.25 s apart.
inline std::string rtklib_pos() {
  return "% program   : made by hand\n"
         "%  GPST            latitude(deg) longitude(deg) height(m) Q ns\n"
         "2025/07/08 19:34:18.499 48.5 9.25 300.125 1 21\n"
         "2025/07/08 19:34:18.749 48.5000001 9.25 300.25 1 21\n"
         "2025/07/08 19:34:18.999 48.5000002 9.2500001 300.5 2 20\n";
}

}  // namespace driftlab::testing
