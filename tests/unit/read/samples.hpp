#pragma once
/// Material of the reader suites: valid files of every registered format, compressors, sinks and a directory of its
/// own.
#include "core/read/format.hpp"
#include "tests/unit/read/archives.hpp"
#include "tests/unit/read/hdf5_samples.hpp"
#include "tests/unit/read/inertial_samples.hpp"
#include "tests/unit/read/journey_samples.hpp"

#include <gtest/gtest.h>
#include <lzma.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::testing {

/// Keeps what a decoder delivers, in columns.
class KeepingSink final : public ColumnSink {
 public:
  Status begin(const ColumnLayout& layout) override {
    columns.resize(layout.names.size());
    names = layout.names;
    return {};
  }
  Status rows(std::span<const double> values) override {
    for (std::size_t i = 0; i < values.size(); ++i) {
      columns[i % columns.size()].push_back(values[i]);
    }
    return {};
  }
  Status column(std::size_t index, std::span<const double> values) override {
    columns.at(index).insert(columns.at(index).end(), values.begin(), values.end());
    return {};
  }
  void note(std::string sentence) override { notes.push_back(std::move(sentence)); }

  ColumnNames names;
  std::vector<std::vector<double>> columns;
  std::vector<std::string> notes;
};

/// What came out of some bytes: the samples bit by bit, or the error.
struct Outcome {
  std::optional<ErrorCode> error;
  std::string message;
  std::vector<ErrorField> fields;
  Decoded decoded;
  std::vector<std::vector<std::uint64_t>> bits;

  [[nodiscard]] std::string field(std::string_view name) const {
    for (const ErrorField& field : fields) {
      if (field.name == name) {
        return field.value;
      }
    }
    return "";
  }
  friend bool operator==(const Outcome& a, const Outcome& b) {
    return a.error == b.error && a.message == b.message && a.fields == b.fields && a.bits == b.bits &&
           a.decoded.names == b.decoded.names && a.decoded.rows == b.decoded.rows && a.decoded.notes == b.decoded.notes;
  }
};

/// A value of the table that came out.
inline double cell(const Outcome& outcome, std::size_t column, std::size_t row) {
  return std::bit_cast<double>(outcome.bits[column][row]);
}

// NOLINTNEXTLINE(readability-identifier-naming): GoogleTest looks for this name
inline void PrintTo(const Outcome& outcome, std::ostream* out) {
  if (outcome.error) {
    *out << name_of(*outcome.error) << ": " << outcome.message;
  } else {
    *out << outcome.decoded.rows << " rows x " << outcome.decoded.names.size();
  }
}

inline Outcome decode_bytes(std::string_view bytes, std::size_t piece = static_cast<std::size_t>(-1),
                            const DecodeLimits& limits = {}) {
  KeepingSink sink;
  auto decoded = decode_stream(make_memory_reader(bytes, piece), sink, limits);
  Outcome outcome;
  if (!decoded) {
    outcome.error = decoded.error().code;
    outcome.message = decoded.error().message;
    outcome.fields = decoded.error().fields;
    return outcome;
  }
  outcome.decoded = *decoded;
  for (const auto& column : sink.columns) {
    auto& words = outcome.bits.emplace_back();
    for (const double value : column) {
      words.push_back(std::bit_cast<std::uint64_t>(value));
    }
  }
  return outcome;
}

inline std::string gzip(std::string_view plain) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, plain.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(plain.data()));
  stream.avail_in = static_cast<uInt>(plain.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

inline std::string xz(std::string_view plain) {
  std::string packed(lzma_stream_buffer_bound(plain.size()), '\0');
  std::size_t size = 0;
  EXPECT_EQ(lzma_easy_buffer_encode(6, LZMA_CHECK_CRC64, nullptr, reinterpret_cast<const std::uint8_t*>(plain.data()),
                                    plain.size(), reinterpret_cast<std::uint8_t*>(packed.data()), &size, packed.size()),
            LZMA_OK);
  packed.resize(size);
  return packed;
}

/// With a checksum, as zstd(1) writes it.
inline std::string zstd(std::string_view plain) {
  ZSTD_CCtx* const context = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 1);
  std::string packed(ZSTD_compressBound(plain.size()), '\0');
  const std::size_t size = ZSTD_compress2(context, packed.data(), packed.size(), plain.data(), plain.size());
  ZSTD_freeCCtx(context);
  EXPECT_EQ(ZSTD_isError(size), 0U);
  packed.resize(size);
  return packed;
}

inline std::string compress(Compression kind, std::string_view plain) {
  switch (kind) {
    case Compression::Gzip:
      return gzip(plain);
    case Compression::Xz:
      return xz(plain);
    case Compression::Zstd:
      return zstd(plain);
    case Compression::None:
      break;
  }
  return std::string(plain);
}

inline constexpr std::array kCompressions{Compression::None, Compression::Gzip, Compression::Xz, Compression::Zstd};

/// A .npy file: the header as numpy writes it around `dictionary`, then `data`.
inline std::string npy(const std::string& dictionary, std::string_view data, int version = 1) {
  std::string file = "\x93NUMPY";
  file += static_cast<char>(version);
  file += '\0';
  const std::size_t front = version == 1 ? 10 : 12;
  std::string text = dictionary;
  while ((front + text.size() + 1) % 64 != 0) {
    text += ' ';
  }
  text += '\n';
  for (std::size_t i = 0; i < front - 8; ++i) {
    file += static_cast<char>((text.size() >> (8 * i)) & 0xFFU);
  }
  return file + text + std::string(data);
}

inline std::string npy_dictionary(const std::string& descr, bool fortran_order, const std::string& shape) {
  return "{'descr': '" + descr + "', 'fortran_order': " + (fortran_order ? "True" : "False") + ", 'shape': " + shape +
         ", }";
}

/// Numbers as bytes of `Float`, reversed where `swap`.
template <class Float>
std::string number_bytes(const std::vector<double>& values, bool swap = false) {
  std::string bytes;
  for (const double value : values) {
    const auto stored = static_cast<Float>(value);
    std::string one(reinterpret_cast<const char*>(&stored), sizeof stored);
    bytes += swap ? std::string(one.rbegin(), one.rend()) : one;
  }
  return bytes;
}

inline std::vector<double> ramp(std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = 0.25 * static_cast<double>(i) - 3.0;
  }
  return values;
}

/// Small valid files by format name. A registered format without an entry fails the malformed-input suite.
inline std::map<std::string, std::vector<std::string>> valid_samples() {
  return {
      {"csv",
       {"t,gx,gy\n0.00,1.5,-2\n0.01,1e-3,+4\n0.02,-0.125,6.\n", "gx\n1\n2\n3\n",
        "t,gx [131 LSB/(deg/s)],ax [0.5 mg/LSB]\n0,262,-4\n0.01,,8\n", "1,2\n3,4", "1\n2\n",
        "Time (s);X (rad/s)\n0,5;1,25E-3\n1,0;\n",
        "// Rate: 5\n// Sample rate: 50.0Hz\nCounter\tAcc_X\n 7\t1.5\t\n9\tnan\t\n",
        "-8.42 0.06 5.24\n -8.47 -0.01 \t5.18 \n", "Fs,100\nax,ay,az\n1,2,3\n,two,-9999\n",
        "\xEF\xBB\xBF# made by a logger\r\n\"time (s)\", \"gz, raw\"\r\n0, 1\r\n0.5 , \"2\"\r\n\r\n"}},
      {"npy",
       {npy(npy_dictionary("<f8", false, "(4, 3)"), number_bytes<double>(ramp(12))),
        npy(npy_dictionary("<f4", false, "(5,)"), number_bytes<float>(ramp(5)), 2),
        npy(npy_dictionary(">f8", true, "(3, 2)"), number_bytes<double>(ramp(6), true), 3)}},
      {"npz",
       {zip({{"gyro.npy", npy(npy_dictionary("<f8", false, "(4, 3)"), number_bytes<double>(ramp(12)))},
             {"t.npy", npy(npy_dictionary("<f8", false, "(4,)"), number_bytes<double>(ramp(4)))}})}},
      {"mat5",
       {mat_file({mat_matrix("gyro", 3, 4, ramp(12)), mat_matrix("fs", 1, 1, {100.0})}),
        mat_file({mat_matrix("t", 5, 1, ramp(5)), mat_matrix("w", 5, 3, ramp(15))}, true)}},
      {"hdf5", {unfolded(kHdf5File), unfolded(kMatlab73File)}},
      {"phone_zip",
       {zip({{"Gyroscope.csv", "\"Time (s)\",\"X (rad/s)\",\"Y (rad/s)\"\n0.00,1E-3,2\n0.01,3,4\n0.02,5,6\n"},
             {"Accelerometer.csv", "\"Time (s)\",\"X (m/s^2)\"\n0.011,9.8\n0.021,9.7\n"},
             {"meta/device.csv", "\"property\",\"value\"\n\"model\",\"none\"\n"}}),
        zip({{"Gyroscope.csv", "time,seconds_elapsed,z,y,x\n1,0.00,1,2,3\n2,0.01,3,4,5\n"},
             {"Location.csv", "time,seconds_elapsed,speed,longitude,latitude\n1,-0.5,-1,9,48\n2,0.5,1,9,48\n"}})}},
      {"vmu931", {"Attribute,Time stamp,x,y,z\nG,10,1,2,3\nA,10,0.1,0.2,1\nG,11,2,3,4\nE,11,0,0,0\nA,11,0.1,0.2,1\n"}},
      {"cxd5602",
       {"9b981977,41d84d00,b9685f6a,39738705,b8c2bdea,3e823bd9,bc5bae10,411c758a\r\n"
        "9b9e7c5a,41d81f00,38b19c82,3a490aa1,b8eed188,3e81f398,bc33c37e,411c991c\r\n"}},
      {"ulog", {ulog(inertial_rows()), ulog_with_fixes()}},
      {"dataflash", {dataflash(inertial_rows()), dataflash_with_fixes()}},
      {"cwa", {cwa()}},
      {"euroc", {euroc(inertial_rows(3))}},
      {"euroc_zip",
       {zip({{"mav0/cam0/data.csv", "#timestamp [ns],filename\n1,1.png\n"},
             {"mav0/imu0/data.csv", euroc(inertial_rows(2))}})}},
      {"rostopic", {rostopic(inertial_rows(3))}},
      {"kf_gins", {kf_gins(inertial_rows(10))}},
      {"rtklib_pos", {rtklib_pos()}},
      {"nmea", {nmea()}},
      {"ubx", {ubx_pvt(3)}},
      {"kitti", {zip(kitti_files(3))}},
      {"geneactiv", {geneactiv()}},
      {"rosbag2", {rosbag2(inertial_rows(2)), journey_bag2(2)}},
      {"mcap",
       {mcap(inertial_rows(2)), mcap(inertial_rows(2), "zstd", "ros1"), mcap(inertial_rows(2), "lz4"),
        journey_mcap(2)}},
      {"rosbag",
       {rosbag(inertial_rows(2)), rosbag(inertial_rows(2), "bz2"), rosbag(inertial_rows(2), "lz4"), journey_bag(2)}},
  };
}

/// A directory that goes away with its content.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "driftlab-read-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  [[nodiscard]] std::vector<std::string> entries() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

 private:
  std::filesystem::path path_;
};

inline void write_file(const std::filesystem::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace driftlab::testing
