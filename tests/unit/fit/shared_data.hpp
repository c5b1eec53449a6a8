#pragma once
/// Recordings that are not part of the repository: found through DRIFTLAB_SHARED, default ../shared.
#include "tests/shared_folder.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace driftlab::shared_data {

/// The folder, or nothing, said loudly.
inline std::optional<std::filesystem::path> folder() { return shared_folder(); }

/// Columns of an xz-compressed NumPy file of little-endian doubles in C order.
inline std::vector<std::vector<double>> read_npy_xz(const std::filesystem::path& path, std::size_t columns) {
  const std::string command = "xz -dc '" + path.string() + "'";
  std::FILE* const pipe = popen(command.c_str(), "r");
  std::string bytes;
  std::vector<char> buffer(1 << 20);
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    bytes.append(buffer.data(), count);
  }
  pclose(pipe);
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(bytes.at(i))); };
  const std::size_t header = 10 + byte(8) + 256 * byte(9);
  const std::size_t rows = (bytes.size() - header) / sizeof(double) / columns;
  std::vector<double> values(rows * columns);
  std::memcpy(values.data(), bytes.data() + header, values.size() * sizeof(double));
  std::vector<std::vector<double>> split(columns, std::vector<double>(rows));
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t c = 0; c < columns; ++c) {
      split[c][row] = values[row * columns + c];
    }
  }
  return split;
}

inline const std::vector<std::string>& adis_axes() {
  static const std::vector<std::string> axes{"gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"};
  return axes;
}

}  // namespace driftlab::shared_data
