#include "core/read/column_file.hpp"
#include "core/read/column_layout.hpp"
#include "core/read/posix_file.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <set>
#include <utility>

namespace driftlab {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kBufferBytes = std::size_t{16} << 20;

/// Values each column buffers: all buffers together stay within kBufferBytes, one spill is at most 512 KiB.
std::size_t buffer_values(std::size_t columns) {
  return std::clamp<std::size_t>(kBufferBytes / sizeof(double) / columns, 32, 65536);
}

/// A file without a name, in the directory of `path`: it is gone when the process is, however that ends.
Result<posix::FileDescriptor> open_spool(const fs::path& path) {
  const fs::path directory = path.has_parent_path() ? path.parent_path() : fs::path(".");
  posix::FileDescriptor file(::open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
  if (file.get() >= 0) {
    return file;
  }
  // File systems without O_TMPFILE: a name for an instant.
  std::string name = path.string() + ".spool-XXXXXX";
  file = posix::FileDescriptor(::mkostemp(name.data(), O_CLOEXEC));
  if (file.get() < 0) {
    return fail(posix::io_error(errno, "write", path));
  }
  ::unlink(name.c_str());
  return file;
}

/// A run of one column's values in the spool file.
struct Extent {
  std::size_t offset = 0;
  std::size_t bytes = 0;
};

/// One column under construction: `count` values, of which the last `filled` are in `buffer`.
struct GrowingColumn {
  std::vector<double> buffer;
  std::size_t filled = 0;
  std::size_t count = 0;
  std::vector<Extent> extents;
};

std::span<const std::byte> unwritten(const GrowingColumn& column) {
  return std::as_bytes(std::span(column.buffer).first(column.filled));
}

/// Unlinks a file that was not released.
class PartialFile {
 public:
  explicit PartialFile(fs::path path) : path_(std::move(path)) {}
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile() {
    if (!path_.empty()) {
      ::unlink(path_.c_str());
    }
  }
  [[nodiscard]] const fs::path& path() const { return path_; }
  void release() { path_.clear(); }

 private:
  fs::path path_;
};

}  // namespace

struct ColumnFileWriter::State {
  fs::path path;
  ColumnNames names;
  std::size_t capacity = 0;  ///< values per buffer
  std::vector<GrowingColumn> columns;
  posix::FileDescriptor spool;  ///< opened by the first spill: a small table never needs it
  std::size_t spool_bytes = 0;

  [[nodiscard]] Status spill(GrowingColumn& column);
  [[nodiscard]] Status append(GrowingColumn& column, const double* values, std::size_t count, std::size_t step);
  [[nodiscard]] Status write_column(const GrowingColumn& column, int target, const fs::path& part) const;
  [[nodiscard]] Status write_table(int target, const fs::path& part) const;
};

Status ColumnFileWriter::State::spill(GrowingColumn& column) {
  if (spool.get() < 0) {
    auto opened = open_spool(path);
    if (!opened) {
      return fail(opened.error());
    }
    spool = std::move(*opened);
  }
  const auto bytes = unwritten(column);
  if (auto status = posix::write_all(spool.get(), bytes, path); !status) {
    return status;
  }
  column.extents.push_back({spool_bytes, bytes.size()});
  spool_bytes += bytes.size();
  column.filled = 0;
  return {};
}

Status ColumnFileWriter::State::append(GrowingColumn& column, const double* values, std::size_t count,
                                       std::size_t step) {
  while (count > 0) {
    if (column.filled == capacity) {
      if (auto status = spill(column); !status) {
        return status;
      }
    }
    const std::size_t batch = std::min(count, capacity - column.filled);
    if (column.buffer.size() < column.filled + batch) {
      column.buffer.resize(std::min(capacity, std::max(column.filled + batch, 2 * column.buffer.size())));
    }
    double* const into = column.buffer.data() + column.filled;
    for (std::size_t i = 0; i < batch; ++i) {
      into[i] = values[i * step];
    }
    values += batch * step;
    column.filled += batch;
    column.count += batch;
    count -= batch;
  }
  return {};
}

Status ColumnFileWriter::State::write_column(const GrowingColumn& column, int target, const fs::path& part) const {
  for (const Extent& extent : column.extents) {
    if (auto status = posix::copy_range(spool.get(), extent.offset, target, extent.bytes, part); !status) {
      return status;
    }
  }
  if (auto status = posix::write_all(target, unwritten(column), part); !status) {
    return status;
  }
  static constexpr std::array<std::byte, 64> kZeros{};
  const std::size_t bytes = column.count * sizeof(double);
  return posix::write_all(target, std::span(kZeros).first(column_layout::round_up(bytes) - bytes), part);
}

Status ColumnFileWriter::State::write_table(int target, const fs::path& part) const {
  const auto front = column_layout::encode_front(names, columns.front().count);
  if (auto status = posix::write_all(target, front, part); !status) {
    return status;
  }
  for (const GrowingColumn& column : columns) {
    if (auto status = write_column(column, target, part); !status) {
      return status;
    }
  }
  if (::fsync(target) != 0) {
    return fail(posix::io_error(errno, "write", part));
  }
  return {};
}

ColumnFileWriter::ColumnFileWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
ColumnFileWriter::ColumnFileWriter(ColumnFileWriter&&) noexcept = default;
ColumnFileWriter& ColumnFileWriter::operator=(ColumnFileWriter&&) noexcept = default;
ColumnFileWriter::~ColumnFileWriter() = default;

Result<ColumnFileWriter> ColumnFileWriter::create(const fs::path& path, ColumnNames names) {
  if (names.empty() || names.size() > column_layout::kMaxColumns) {
    return fail(ErrorCode::InvalidArgument, "A column file has 1 to " + std::to_string(column_layout::kMaxColumns) +
                                                " columns, not " + std::to_string(names.size()) + ".");
  }
  std::set<std::string_view> seen;
  for (const std::string& name : names) {
    if (!seen.insert(name).second) {
      return fail(ErrorCode::DuplicateColumn, "Two columns are called '" + name + "'.", {{"column", name}});
    }
  }
  auto state = std::make_unique<State>();
  state->path = path;
  state->capacity = buffer_values(names.size());
  state->columns.resize(names.size());
  state->names = std::move(names);
  return ColumnFileWriter(std::move(state));
}

Status ColumnFileWriter::append_rows(std::span<const double> values) {
  const std::size_t width = state_->columns.size();
  assert(values.size() % width == 0);
  for (std::size_t i = 0; i < width; ++i) {
    if (auto status = state_->append(state_->columns[i], values.data() + i, values.size() / width, width); !status) {
      return status;
    }
  }
  return {};
}

Status ColumnFileWriter::append_column(std::size_t column, std::span<const double> values) {
  assert(column < state_->columns.size());
  return state_->append(state_->columns[column], values.data(), values.size(), 1);
}

Result<std::size_t> ColumnFileWriter::finish() {
  const std::size_t rows = state_->columns.front().count;
  for (std::size_t i = 0; i < state_->columns.size(); ++i) {
    if (state_->columns[i].count != rows) {
      return fail(ErrorCode::ShapeMismatch,
                  "Column '" + state_->names[i] + "' has " + std::to_string(state_->columns[i].count) +
                      " samples, the first column has " + std::to_string(rows) + ".",
                  {{"column", state_->names[i]}});
    }
  }
  PartialFile part(state_->path.string() + ".part");
  const posix::FileDescriptor target(
      ::open(part.path().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0644));
  if (target.get() < 0) {
    const int reason = errno;
    part.release();
    return fail(posix::io_error(reason, "create", state_->path));
  }
  if (auto status = state_->write_table(target.get(), state_->path); !status) {
    return fail(status.error());
  }
  if (std::rename(part.path().c_str(), state_->path.c_str()) != 0) {
    return fail(posix::io_error(errno, "create", state_->path));
  }
  part.release();
  state_->spool = {};
  return rows;
}

}  // namespace driftlab
