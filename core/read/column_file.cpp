#include "core/read/column_file.hpp"

#include "core/read/column_layout.hpp"
#include "core/read/posix_file.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <utility>

namespace driftlab {

Result<ColumnFile> ColumnFile::open(const std::filesystem::path& path) {
  auto file = posix::open_to_read(path);
  if (!file) {
    return fail(file.error());
  }
  auto size = posix::regular_file_size(file->get(), path);
  if (!size) {
    return fail(size.error());
  }
  if (*size == 0) {
    return fail(column_layout::decode_header({}, path).error());
  }
  void* const base = ::mmap(nullptr, *size, PROT_READ, MAP_SHARED, file->get(), 0);
  if (base == MAP_FAILED) {
    return fail(posix::io_error(errno, "map", path));
  }
  ColumnFile table;  // unmaps on every return below
  table.base_ = static_cast<const std::byte*>(base);
  table.size_ = *size;
  auto header = column_layout::decode_header({table.base_, table.size_}, path);
  if (!header) {
    return fail(header.error());
  }
  auto names = column_layout::decode_names({table.base_, table.size_}, *header, path);
  if (!names) {
    return fail(names.error());
  }
  table.rows_ = header->rows;
  table.stride_ = header->stride;
  table.data_offset_ = header->data_offset;
  table.names_ = std::move(*names);
  return table;
}

ColumnFile::ColumnFile(ColumnFile&& other) noexcept
    : base_(std::exchange(other.base_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      rows_(std::exchange(other.rows_, 0)),
      stride_(other.stride_),
      data_offset_(other.data_offset_),
      names_(std::move(other.names_)) {}

ColumnFile& ColumnFile::operator=(ColumnFile&& other) noexcept {
  if (this != &other) {
    std::swap(base_, other.base_);
    std::swap(size_, other.size_);
    rows_ = std::exchange(other.rows_, 0);
    stride_ = other.stride_;
    data_offset_ = other.data_offset_;
    names_ = std::move(other.names_);
  }
  return *this;
}

ColumnFile::~ColumnFile() {
  if (base_ != nullptr) {
    ::munmap(const_cast<std::byte*>(base_), size_);
  }
}

std::span<const double> ColumnFile::column(std::size_t i) const {
  assert(i < names_.size());
  return {reinterpret_cast<const double*>(base_ + data_offset_ + i * stride_), rows_};
}

void ColumnFile::release(std::span<const double> samples) const {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const auto offset = static_cast<std::size_t>(reinterpret_cast<const std::byte*>(samples.data()) - base_);
  const std::size_t first = (offset + page - 1) / page * page;  // whole pages inside
  const std::size_t last = (offset + samples.size_bytes()) / page * page;
  if (last > first) {
    ::madvise(const_cast<std::byte*>(base_) + first, last - first, MADV_DONTNEED);
  }
}

}  // namespace driftlab
