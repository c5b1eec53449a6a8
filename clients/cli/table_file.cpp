#include "clients/cli/table_file.hpp"

#include <zlib.h>

#include <cstdio>
#include <cstring>
#include <vector>

namespace driftlab::cli {
namespace {

constexpr std::string_view kPacked = ".gz";

/// A file that is written from front to back, packed by gzip where its name ends with `.gz`.
class TableFile {
 public:
  /// `T`: written as it is.
  explicit TableFile(const std::string& path)
      : stream_(::gzopen(path.c_str(), path.ends_with(kPacked) ? "wb" : "wbT")) {}
  TableFile(const TableFile&) = delete;
  TableFile& operator=(const TableFile&) = delete;
  ~TableFile() { (void)closed(); }

  void write(const char* bytes, std::size_t count) {
    const auto length = static_cast<unsigned>(count);  // a line or a row
    whole_ = whole_ && stream_ != nullptr && ::gzwrite(stream_, bytes, length) == static_cast<int>(length);
  }

  /// Was everything written?
  [[nodiscard]] bool closed() {
    if (stream_ != nullptr) {
      whole_ = ::gzclose(stream_) == Z_OK && whole_;
      stream_ = nullptr;
      return whole_;
    }
    return false;
  }

 private:
  gzFile stream_;
  bool whole_ = true;
};

void write_npy(TableFile& out, const SampleTable& table) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (";
  header.append(std::to_string(table.rows())).append(", ").append(std::to_string(table.columns.size())).append("), }");
  // Magic, version and length take 10 bytes; the whole is padded to a multiple of 64 (NEP 1).
  header.append((64 - (10 + header.size() + 1) % 64) % 64, ' ').append("\n");
  const char length[2] = {static_cast<char>(header.size() & 0xFFU), static_cast<char>(header.size() >> 8U)};
  out.write("\x93NUMPY\x01\x00", 8);
  out.write(length, 2);
  out.write(header.data(), header.size());
  std::vector<char> row(table.columns.size() * sizeof(double));
  for (std::size_t r = 0; r < table.rows(); ++r) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      const double value = table.at(r, c);
      std::memcpy(row.data() + c * sizeof(double), &value, sizeof value);
    }
    out.write(row.data(), row.size());
  }
}

void write_csv(TableFile& out, const std::string& comment, const SampleTable& table) {
  std::string line = "# " + comment + "\n";
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    line.append(c == 0 ? "" : ",").append(table.columns[c]);
  }
  line.append("\n");
  out.write(line.data(), line.size());
  for (std::size_t r = 0; r < table.rows(); ++r) {
    line.clear();
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      char cell[64];
      const int length = std::snprintf(cell, sizeof cell, "%.*f", table.decimals[c], table.at(r, c));
      line.append(c == 0 ? "" : ",").append(cell, static_cast<std::size_t>(length));
    }
    line.append("\n");
    out.write(line.data(), line.size());
  }
}

}  // namespace

bool is_array_name(std::string_view path) {
  if (path.ends_with(kPacked)) {
    path.remove_suffix(kPacked.size());
  }
  return path.ends_with(".npy");
}

Status write_table(const std::string& path, const std::string& comment, const SampleTable& table) {
  for (const std::string_view other : {".xz", ".zst", ".bz2", ".zip", ".7z"}) {
    if (path.ends_with(other)) {
      return fail(ErrorCode::InvalidArgument,
                  "The file " + path + " cannot be written: tables are packed as " + std::string(kPacked) + " alone.",
                  {{"path", path}});
    }
  }
  TableFile out(path);
  if (is_array_name(path)) {
    write_npy(out, table);
  } else {
    write_csv(out, comment, table);
  }
  if (!out.closed()) {
    return fail(ErrorCode::Io, "The file " + path + " cannot be written.", {{"path", path}});
  }
  return {};
}

}  // namespace driftlab::cli
