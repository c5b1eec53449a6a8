#include "core/read/zip_entries.hpp"

#include "core/read/format.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>
#include <vector>

namespace driftlab {
namespace {

constexpr std::size_t kBlock = std::size_t{64} * 1024;

/// What libarchive pulls from: whole blocks, so that its answers do not depend on how the bytes arrive.
struct Feed {
  ByteSource& source;
  std::vector<char> block = std::vector<char>(kBlock);
  std::optional<Error> error = std::nullopt;
  bool ended = false;

  la_ssize_t next(const void** bytes) {
    std::size_t filled = 0;
    while (filled < block.size() && !ended) {
      auto view = source.view();
      if (!view) {
        error = view.error();
        return -1;
      }
      const std::size_t count = std::min(view->size(), block.size() - filled);
      std::copy_n(view->begin(), count, block.data() + filled);
      source.consume(count);
      filled += count;
      ended = count == 0;
    }
    *bytes = block.data();
    return static_cast<la_ssize_t>(filled);
  }
};

la_ssize_t read_block(archive* /*reader*/, void* feed, const void** bytes) {
  return static_cast<Feed*>(feed)->next(bytes);
}

/// An archive being read.
struct Zip {
  Feed feed;
  std::uint64_t budget = 0;
  std::uint64_t produced = 0;
  std::unique_ptr<archive, int (*)(archive*)> handle{::archive_read_new(), ::archive_read_free};

  [[nodiscard]] Error damaged() const {
    if (feed.error) {
      return *feed.error;
    }
    return feed.ended ? Error{ErrorCode::Truncated,
                              "The ZIP archive ends before it is complete, or is damaged; copy the file again."}
                      : Error{ErrorCode::CorruptCompression, "The ZIP archive is damaged; copy the file again."};
  }
};

/// The bytes of the current entry.
class EntryReader final : public ByteReader {
 public:
  explicit EntryReader(Zip& zip) : zip_(zip) {}
  Result<std::size_t> read(std::span<char> into) override {
    const la_ssize_t count = ::archive_read_data(zip_.handle.get(), into.data(), into.size());
    if (count < 0) {
      return fail(zip_.damaged());
    }
    zip_.produced += static_cast<std::uint64_t>(count);
    if (zip_.produced > zip_.budget) {
      return fail(ErrorCode::DecompressionLimit,
                  "The ZIP archive expands to more than " + std::to_string(zip_.budget) +
                      " bytes; no recording compresses that well.",
                  {{"limit", std::to_string(zip_.budget)}});
    }
    return static_cast<std::size_t>(count);
  }
  [[nodiscard]] double fraction() const override { return zip_.feed.source.fraction(); }
  [[nodiscard]] std::uint64_t size() const override { return zip_.feed.source.input_size(); }

 private:
  Zip& zip_;
};

}  // namespace

Status for_each_zip_entry(ByteSource& source, const DecodeLimits& limits,
                          const std::function<Status(const std::string& path, ByteSource& content)>& take) {
  Zip zip{Feed{source}, limits.expanded_budget(source.input_size())};
  if (!zip.handle || ::archive_read_support_format_zip_streamable(zip.handle.get()) != ARCHIVE_OK) {
    return fail(ErrorCode::Internal, "The ZIP reader could not be started.");
  }
  if (::archive_read_open(zip.handle.get(), &zip.feed, nullptr, read_block, nullptr) != ARCHIVE_OK) {
    return fail(zip.damaged());
  }
  while (true) {
    archive_entry* entry = nullptr;
    const int code = ::archive_read_next_header(zip.handle.get(), &entry);
    if (code == ARCHIVE_EOF) {
      break;
    }
    if (code != ARCHIVE_OK && code != ARCHIVE_WARN) {
      return fail(zip.damaged());
    }
    if (::archive_entry_is_encrypted(entry) != 0) {
      return fail(ErrorCode::UnsupportedType, "The ZIP archive is encrypted.");
    }
    const char* const path = ::archive_entry_pathname(entry);
    ByteSource content(std::make_unique<EntryReader>(zip));
    if (auto status = take(path != nullptr ? path : "", content); !status) {
      return status;
    }
  }
  // What libarchive has not asked for: the directory at the end, and whatever was put behind it.
  while (!zip.feed.ended) {
    const void* rest = nullptr;
    if (zip.feed.next(&rest) < 0) {
      return fail(zip.damaged());
    }
  }
  return {};
}

namespace {

constexpr std::string_view kLocal = "PK\x03\x04";
constexpr std::size_t kLocalBytes = 30;
constexpr std::size_t kMostShown = std::size_t{16} << 20U;

std::uint64_t number_at(std::string_view bytes, std::size_t at, std::size_t count) {
  std::uint64_t number = 0;
  for (std::size_t i = count; i-- > 0;) {
    number = 256 * number + static_cast<unsigned char>(bytes[at + i]);
  }
  return number;
}

/// The next `count` bytes from `at` on; fewer where the file ends.
std::string piece_of(std::ifstream& file, std::uint64_t at, std::size_t count) {
  std::string piece(count, '\0');
  file.clear();
  file.seekg(static_cast<std::streamoff>(at));
  file.read(piece.data(), static_cast<std::streamsize>(count));
  piece.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return piece;
}

/// Where the directory begins by the record at the end of the archive (APPNOTE 6.3, sections 4.3.14 to 4.3.16).
std::optional<std::uint64_t> directory_of(std::ifstream& file, std::uint64_t size) {
  constexpr std::size_t kEndBytes = 22;
  constexpr std::size_t kLocatorBytes = 20;
  constexpr std::uint64_t kIn64Bits = 0xFFFFFFFF;
  const std::uint64_t most = kLocatorBytes + kEndBytes + 0xFFFF;  // the comment behind it
  const std::uint64_t from = size > most ? size - most : 0;
  const std::string tail = piece_of(file, from, static_cast<std::size_t>(size - from));
  const std::size_t end = tail.rfind("PK\x05\x06");
  if (end == std::string::npos || tail.size() - end < kEndBytes) {
    return std::nullopt;
  }
  const std::uint64_t offset = number_at(tail, end + 16, 4);
  if (offset != kIn64Bits) {
    return offset;
  }
  if (end < kLocatorBytes || tail.compare(end - kLocatorBytes, 4, "PK\x06\x07") != 0) {
    return std::nullopt;
  }
  const std::string record = piece_of(file, number_at(tail, end - kLocatorBytes + 8, 8), 56);
  return record.size() == 56 && record.starts_with("PK\x06\x06") ? std::optional(number_at(record, 48, 8))
                                                                 : std::nullopt;
}

/// A local header that names a file and no more.
void append_header(std::string_view path, std::string& headers) {
  headers.append(kLocal).append(kLocalBytes - kLocal.size(), '\0').append(path);
  char* const length = headers.data() + headers.size() - path.size() - 4;
  length[0] = static_cast<char>(path.size() & 0xFFU);
  length[1] = static_cast<char>(path.size() >> 8U & 0xFFU);
}

std::string headers_by_directory(const std::filesystem::path& archive) {
  std::string headers;
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(archive, error);
  std::ifstream file(archive, std::ios::binary);
  const auto begin = error || !file ? std::nullopt : directory_of(file, size);
  constexpr std::size_t kEntryBytes = 46;
  for (std::uint64_t at = begin.value_or(size); at < size && headers.size() < kMostShown;) {
    const std::string entry = piece_of(file, at, kEntryBytes);
    if (entry.size() < kEntryBytes || !entry.starts_with("PK\x01\x02")) {
      break;
    }
    const std::size_t length = number_at(entry, 28, 2);
    append_header(piece_of(file, at + kEntryBytes, length), headers);
    at += kEntryBytes + length + number_at(entry, 30, 2) + number_at(entry, 32, 2);
  }
  return headers;
}

/// Every local header that `head` shows: signature, 22 bytes, two lengths of 16 bits, the path. `take` ends the walk
/// with true.
template <class Take>
bool any_header(std::string_view head, const Take& take) {
  if (!head.starts_with(kLocal)) {
    return false;
  }
  for (std::size_t at = 0; at != std::string_view::npos && at + kLocalBytes <= head.size();
       at = head.find(kLocal, at + kLocal.size())) {
    if (take(head.substr(at + kLocalBytes, number_at(head, at + 26, 2)))) {
      return true;
    }
  }
  return false;
}

}  // namespace

Result<std::string> zip_headers(ByteSource& source) {
  const auto archive = source.path();
  std::string headers = archive ? headers_by_directory(*archive) : std::string();
  const std::size_t most = headers.empty() ? kMostShown : kSniffBytes;
  auto shown = source.view(most);
  if (!shown) {
    return fail(shown.error());
  }
  any_header(shown->substr(0, most), [&](std::string_view path) {
    append_header(path, headers);
    return false;
  });
  return headers;
}

bool is_zip(std::string_view head) { return head.starts_with(kLocal); }

bool zip_holds(std::string_view head, std::string_view suffix) {
  return any_header(head, [&](std::string_view path) { return path.ends_with(suffix); });
}

}  // namespace driftlab
