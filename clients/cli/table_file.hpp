#pragma once
/// Writes columns of numbers as CSV or NumPy file, by the ending of the name.
#include "core/signal/result.hpp"

#include <functional>
#include <string>
#include <vector>

namespace driftlab::cli {

struct TableFile {
  std::string comment;               ///< first line of a CSV, behind `# `
  std::vector<std::string> columns;  ///< `gx [deg/s]`
  std::size_t rows = 0;
  /// One number of the table.
  std::function<double(std::size_t row, std::size_t column)> cell;
  std::vector<int> decimals;  ///< per column in CSV
};

/// `.npy`: version 1.0, little-endian doubles, C order, no names; else CSV with names and units. Error: Io.
[[nodiscard]] Status write_table(const std::string& path, const TableFile& table);

}  // namespace driftlab::cli
