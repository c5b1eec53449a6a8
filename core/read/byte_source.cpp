#include "core/read/byte_source.hpp"

#include "core/read/posix_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 18;
[[maybe_unused]] constexpr std::size_t kMaxView = std::size_t{16} << 20;

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 1.0 : std::min(1.0, static_cast<double>(part) / static_cast<double>(whole));
}

class FileReader final : public ByteReader {
 public:
  FileReader(posix::FileDescriptor file, std::filesystem::path path, std::uint64_t size)
      : file_(std::move(file)), path_(std::move(path)), size_(size) {}

  Result<std::size_t> read(std::span<char> into) override {
    while (true) {
      const ssize_t got = ::read(file_.get(), into.data(), into.size());
      if (got >= 0) {
        taken_ += static_cast<std::uint64_t>(got);
        return static_cast<std::size_t>(got);
      }
      if (errno != EINTR) {
        return fail(posix::io_error(errno, "read", path_));
      }
    }
  }
  [[nodiscard]] double fraction() const override { return ratio(taken_, size_); }
  [[nodiscard]] std::optional<std::filesystem::path> path() const override { return path_; }
  [[nodiscard]] std::uint64_t size() const override { return size_; }

 private:
  posix::FileDescriptor file_;
  std::filesystem::path path_;
  std::uint64_t size_;
  std::uint64_t taken_ = 0;
};

class MemoryReader final : public ByteReader {
 public:
  MemoryReader(std::string_view bytes, std::size_t piece) : rest_(bytes), size_(bytes.size()), piece_(piece) {}

  Result<std::size_t> read(std::span<char> into) override {
    const std::size_t count = std::min({into.size(), rest_.size(), piece_});
    rest_.copy(into.data(), count);
    rest_.remove_prefix(count);
    return count;
  }
  [[nodiscard]] double fraction() const override { return ratio(size_ - rest_.size(), size_); }
  [[nodiscard]] std::uint64_t size() const override { return size_; }

 private:
  std::string_view rest_;
  std::size_t size_;
  std::size_t piece_;
};

}  // namespace

Result<std::unique_ptr<ByteReader>> open_file_reader(const std::filesystem::path& path) {
  auto file = posix::open_to_read(path);
  if (!file) {
    return fail(file.error());
  }
  auto size = posix::regular_file_size(file->get(), path);
  if (!size) {
    return fail(size.error());
  }
  ::posix_fadvise(file->get(), 0, 0, POSIX_FADV_SEQUENTIAL);
  return std::make_unique<FileReader>(std::move(*file), path, *size);
}

std::unique_ptr<ByteReader> make_memory_reader(std::string_view bytes, std::size_t piece) {
  assert(piece > 0);
  return std::make_unique<MemoryReader>(bytes, piece);
}

ByteSource::ByteSource(std::unique_ptr<ByteReader> reader) : reader_(std::move(reader)) {}

Result<std::string_view> ByteSource::view(std::size_t at_least) {
  assert(at_least > 0 && at_least <= kMaxView);
  while (end_ - begin_ < at_least && !ended_) {
    if (begin_ > 0) {
      std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
      end_ -= begin_;
      begin_ = 0;
    }
    if (buffer_.size() < std::max(at_least, kBufferBytes)) {
      buffer_.resize(std::max(at_least, kBufferBytes));
    }
    auto got = reader_->read(std::span(buffer_).subspan(end_));
    if (!got) {
      return fail(got.error());
    }
    end_ += *got;
    ended_ = *got == 0;
  }
  return std::string_view(buffer_.data() + begin_, end_ - begin_);
}

void ByteSource::consume(std::size_t count) {
  assert(count <= end_ - begin_);
  begin_ += count;
  offset_ += count;
}

}  // namespace driftlab
