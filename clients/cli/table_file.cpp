#include "clients/cli/table_file.hpp"

#include <cstdio>
#include <cstring>
#include <fstream>

namespace driftlab::cli {
namespace {

void write_npy(std::ofstream& out, const SampleTable& table) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (";
  header.append(std::to_string(table.rows())).append(", ").append(std::to_string(table.columns.size())).append("), }");
  // Magic, version and length take 10 bytes; the whole is padded to a multiple of 64 (NEP 1).
  header.append((64 - (10 + header.size() + 1) % 64) % 64, ' ').append("\n");
  const char length[2] = {static_cast<char>(header.size() & 0xFFU), static_cast<char>(header.size() >> 8U)};
  out.write("\x93NUMPY\x01\x00", 8);
  out.write(length, 2);
  out.write(header.data(), static_cast<std::streamsize>(header.size()));
  std::vector<char> row(table.columns.size() * sizeof(double));
  for (std::size_t r = 0; r < table.rows(); ++r) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const double value = table.at(r, c);
      std::memcpy(row.data() + c * sizeof(double), &value, sizeof value);
    }
    out.write(row.data(), static_cast<std::streamsize>(row.size()));
  }
}

void write_csv(std::ofstream& out, const std::string& comment, const SampleTable& table) {
  out << "# " << comment << "\n";
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    out << (c == 0 ? "" : ",") << table.columns[c];
  }
  out << "\n";
  std::string line;
  for (std::size_t r = 0; r < table.rows(); ++r) {
    line.clear();
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      char cell[64];
      const int length = std::snprintf(cell, sizeof cell, "%.*f", table.decimals[c], table.at(r, c));
      line.append(c == 0 ? "" : ",").append(cell, static_cast<std::size_t>(length));
    }
    line.append("\n");
    out.write(line.data(), static_cast<std::streamsize>(line.size()));
  }
}

}  // namespace

Status write_table(const std::string& path, const std::string& comment, const SampleTable& table) {
  std::ofstream out(path, std::ios::binary);
  if (path.ends_with(".npy")) {
    write_npy(out, table);
  } else {
    write_csv(out, comment, table);
  }
  out.close();
  if (!out) {
    return fail(ErrorCode::Io, "The file " + path + " cannot be written.", {{"path", path}});
  }
  return {};
}

}  // namespace driftlab::cli
