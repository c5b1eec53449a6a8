#pragma once
/// Small valid ZIP archives and MATLAB files, byte by byte.
#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::testing {

inline std::string word(std::uint64_t value, int bytes) {
  std::string text;
  for (int i = 0; i < bytes; ++i) {
    text += static_cast<char>(i < 8 ? (value >> (8 * i)) & 0xFFU : 0U);
  }
  return text;
}

/// zlib (`wrapped`) or raw deflate.
inline std::string deflated(std::string_view plain, bool wrapped) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, wrapped ? 15 : -15, 8, Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, plain.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(plain.data()));
  stream.avail_in = static_cast<uInt>(plain.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

/// A ZIP archive of deflated files (APPNOTE 6.3, sections 4.3.7, 4.3.12, 4.3.16).
inline std::string zip(const std::vector<std::pair<std::string, std::string>>& files) {
  std::string archive;
  std::string directory;
  for (const auto& [path, content] : files) {
    const std::string packed = deflated(content, false);
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
    const std::string common = word(20, 2) + word(0, 2) + word(8, 2) + word(0, 4) + word(crc, 4) +
                               word(packed.size(), 4) + word(content.size(), 4) + word(path.size(), 2) + word(0, 2);
    directory.append("PK\x01\x02").append(word(20, 2)).append(common).append(std::string(10, '\0'));
    directory.append(word(archive.size(), 4)).append(path);
    archive.append("PK\x03\x04").append(common).append(path).append(packed);
  }
  const std::string end = "PK\x05\x06" + word(0, 4) + word(files.size(), 2) + word(files.size(), 2) +
                          word(directory.size(), 4) + word(archive.size(), 4) + word(0, 2);
  return archive + directory + end;
}

/// The unit's files of a KITTI raw drive at 10 Hz. Angles of lat and lon grow, the rest is known.
inline std::vector<std::pair<std::string, std::string>> kitti_files(std::size_t count,
                                                                    const std::string& folder = "2011_09_26/drive/") {
  std::vector<std::pair<std::string, std::string>> files;
  std::string stamps;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string tenth = std::to_string(i % 10);
    const std::string second = std::to_string(10 + i / 10);
    stamps.append("2011-09-26 13:02:").append(second).append(".").append(tenth).append("00000000\n");
    const std::string number = std::to_string(i);
    std::string name = folder + "oxts/data/";
    name.append(10 - number.size(), '0').append(number).append(".txt");
    std::string latitude = "49.";
    latitude.append(5 - number.size(), '0').append(number);
    // 11 to 13 are the acceleration, 17 to 19 the rates about the unit's axes
    files.emplace_back(std::move(name),
                       latitude +
                           " 8.4 112.8 0.03 0.007 -0.3 -3.5 10.5 11 0.1 0 0.5 -0.25 9.8125 0.6 -0.2 9.7 "
                           "0.125 -0.5 0.0625 0.2 0.3 0.4 0.05 0.02 4 11 6 6 6\n");
  }
  files.emplace_back(folder + "oxts/timestamps.txt", stamps);
  return files;
}

/// One element of a MATLAB 5 file, padded to 8 bytes.
inline std::string mat_element(std::uint32_t type, const std::string& data) {
  return word(type, 4) + word(data.size(), 4) + data + std::string((8 - data.size() % 8) % 8, '\0');
}

/// The head of a matrix element: flags, dimensions, name.
inline std::string mat_head(unsigned array_class, std::uint32_t rows, std::uint32_t columns, const std::string& name) {
  return mat_element(6, word(array_class, 4) + word(0, 4)) + mat_element(5, word(rows, 4) + word(columns, 4)) +
         mat_element(1, name);
}

/// A real matrix of doubles, column by column.
inline std::string mat_matrix(const std::string& name, std::uint32_t rows, std::uint32_t columns,
                              const std::vector<double>& values) {
  std::string data(values.size() * sizeof(double), '\0');
  std::memcpy(data.data(), values.data(), data.size());
  return mat_element(14, mat_head(6, rows, columns, name) + mat_element(9, data));
}

/// A MATLAB 5 file of elements, each compressed on request.
inline std::string mat_file(const std::vector<std::string>& elements, bool compressed = false) {
  std::string file = "MATLAB 5.0 MAT-file, made by hand";
  file.resize(124, ' ');
  file += word(0x0100, 2) + "IM";
  for (const std::string& element : elements) {
    const std::string packed = compressed ? deflated(element, true) : "";
    file += compressed ? word(15, 4) + word(packed.size(), 4) + packed : element;
  }
  return file;
}

}  // namespace driftlab::testing
