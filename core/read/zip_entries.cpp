#include "core/read/zip_entries.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
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

bool zip_holds(std::string_view head, std::string_view suffix) {
  if (!head.starts_with("PK\x03\x04")) {
    return false;
  }
  // Every local header shown: signature, 22 bytes, two lengths of 16 bits, the path.
  for (std::size_t at = 0; at != std::string_view::npos && at + 30 <= head.size();
       at = head.find("PK\x03\x04", at + 4)) {
    const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(head[at + i])); };
    const std::string_view path = head.substr(at + 30, byte(26) + 256 * byte(27));
    if (path.size() >= suffix.size() && path.substr(path.size() - suffix.size()) == suffix) {
      return true;
    }
  }
  return false;
}

}  // namespace driftlab
