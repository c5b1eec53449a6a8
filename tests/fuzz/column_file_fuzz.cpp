/// Any bytes as a column file: refused, or every value of every column can be read. The checksum is made right first,
/// or no mutation would get behind it.
#include "core/read/column_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

namespace {

/// FNV-1a over bytes 0..55 and the names, as column_file.hpp documents it.
void sign(std::vector<std::uint8_t>& bytes) {
  std::uint64_t names = 0;
  if (bytes.size() < 64) {
    return;
  }
  std::memcpy(&names, bytes.data() + 40, sizeof names);
  if (names > bytes.size() - 64) {
    return;
  }
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (std::size_t i = 0; i < 64 + names; ++i) {
    if (i < 56 || i >= 64) {
      hash = (hash ^ bytes[i]) * 0x100000001b3U;
    }
  }
  std::memcpy(bytes.data() + 56, &hash, sizeof hash);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const int file = ::memfd_create("column-file", 0);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  static volatile double kept = 0.0;
  std::vector<std::uint8_t> bytes(data, data + size);
  sign(bytes);
  if (::ftruncate(file, 0) != 0 || ::pwrite(file, bytes.data(), size, 0) != static_cast<ssize_t>(size)) {
    std::abort();
  }
  const auto table = driftlab::ColumnFile::open(path);
  if (!table) {
    return 0;
  }
  for (std::size_t i = 0; i < table->names().size(); ++i) {
    for (const double value : table->column(i)) {
      kept = kept + value;  // a read that the compiler must keep
    }
  }
  return 0;
}
