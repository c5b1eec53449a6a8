#include "server/store/postgres/database_blobs.hpp"

#include "server/store/checksums.hpp"
#include "server/store/crash_point.hpp"
#include "server/store/digest.hpp"
#include "server/store/files.hpp"

#include <fcntl.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

/// A database that is restarted meanwhile is no damage of a recording.
constexpr int kAttempts = 5;
constexpr auto kPause = std::chrono::seconds(1);
constexpr std::size_t kPartBytes = 1U << 20U;
/// Copies that were used a moment ago are not removed: somebody is about to open them.
constexpr auto kJustUsed = std::chrono::minutes(5);

constexpr std::string_view kKnown = "SELECT id, sha256 FROM stored_files WHERE blob = ?1 AND kind = ?2";
constexpr std::string_view kBegin =
    "INSERT INTO stored_files (blob, written_at) VALUES (?1, CAST(?2 AS BIGINT)) RETURNING id";
constexpr std::string_view kAddPart =
    "INSERT INTO stored_file_parts (file_id, number, content) VALUES (?1, ?2, decode(?3, 'base64'))";
constexpr std::string_view kReplace = "DELETE FROM stored_files WHERE blob = ?1 AND kind = ?2";
constexpr std::string_view kEnd =
    "UPDATE stored_files SET kind = ?2, bytes = ?3, sha256 = ?4, written_at = ?5 WHERE id = ?1";
constexpr std::string_view kAsNew = "UPDATE stored_files SET written_at = ?2 WHERE id = ?1";
constexpr std::string_view kPart =
    "SELECT encode(content, 'base64') FROM stored_file_parts WHERE file_id = ?1 AND number = ?2";
constexpr std::string_view kRemove = "DELETE FROM stored_files WHERE blob = ?1";
constexpr std::string_view kRemoveOld =
    "DELETE FROM stored_files WHERE blob = ?1 AND NOT EXISTS (SELECT 1 FROM stored_files AS newer WHERE newer.blob = "
    "?1 AND newer.written_at >= ?2)";
constexpr std::string_view kRemoveUnfinished = "DELETE FROM stored_files WHERE kind IS NULL AND written_at < ?1";
constexpr std::string_view kOld =
    "SELECT DISTINCT blob FROM stored_files WHERE kind IS NOT NULL AND written_at < ?1 ORDER BY blob";

std::string to_base64(std::span<const std::byte> bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');
  const int length =
      EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                      reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

/// The server breaks lines, which are left out; nothing for what is no base64.
std::optional<std::string> from_base64(std::string text) {
  std::erase(text, '\n');
  std::string bytes(text.size() / 4 * 3, '\0');
  const int length =
      EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                      reinterpret_cast<const unsigned char*>(text.data()), static_cast<int>(text.size()));
  if (length < 0) {
    return std::nullopt;
  }
  const auto padding = static_cast<std::size_t>(
      std::count(text.end() - std::min<long>(2, static_cast<long>(text.size())), text.end(), '='));
  bytes.resize(static_cast<std::size_t>(length) - padding);
  return bytes;
}

/// Gives `use` the file in parts. Errors: Io; those of `use`.
Status for_each_part(const fs::path& path, const std::function<Status(std::span<const std::byte>)>& use) {
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> part(kPartBytes);
  if (!stream) {
    return fail(file_error(errno, "open", path));
  }
  while (stream) {
    stream.read(part.data(), static_cast<std::streamsize>(part.size()));
    const auto got = static_cast<std::size_t>(stream.gcount());
    if (got > 0) {
      if (Status used = use(std::as_bytes(std::span(part.data(), got))); !used) {
        return used;
      }
    }
  }
  return stream.bad() ? Status(fail(file_error(EIO, "read", path))) : Status{};
}

bool is_there(const fs::path& path) { return ::access(path.c_str(), F_OK) == 0; }

/// What an upload writes: into the local directory first, then into the database.
class IncomingCopy final : public IncomingBlob {
 public:
  IncomingCopy(DatabaseBlobs& blobs, std::unique_ptr<IncomingBlob> local) : blobs_(blobs), local_(std::move(local)) {}
  [[nodiscard]] Status append(std::span<const std::byte> bytes) override { return local_->append(bytes); }
  [[nodiscard]] Status seal() override { return local_->seal(); }
  [[nodiscard]] const std::string& sha256() const override { return local_->sha256(); }
  [[nodiscard]] std::size_t size() const override { return local_->size(); }
  [[nodiscard]] const fs::path& path() const override { return local_->path(); }
  [[nodiscard]] fs::path columns_path() const override { return local_->columns_path(); }
  [[nodiscard]] Status keep() override {
    if (Status kept = local_->keep(); !kept) {
      return kept;
    }
    return blobs_.store_files(local_->sha256());
  }

 private:
  DatabaseBlobs& blobs_;
  std::unique_ptr<IncomingBlob> local_;
};

/// The files of a blob beside its bytes, each with its kind, columns last: once they are there, the others are.
std::vector<std::pair<std::string_view, fs::path>> files_of_columns(const fs::path& columns) {
  const fs::path pyramid = pyramid_path(columns);
  return {{"pyramid.sha256", columns_checksum_path(pyramid)},
          {"pyramid", pyramid},
          {"columns.sha256", columns_checksum_path(columns)},
          {"columns", columns}};
}

}  // namespace

Result<std::unique_ptr<IncomingBlob>> DatabaseBlobs::begin() {
  auto local = local_->begin();
  if (!local) {
    return local;
  }
  return std::make_unique<IncomingCopy>(*this, std::move(*local));
}

fs::path DatabaseBlobs::bytes_path(std::string_view sha256) const {
  fs::path path = local_->bytes_path(sha256);
  fetch(std::string(sha256), "bytes", path);
  return path;
}

fs::path DatabaseBlobs::columns_path(std::string_view sha256) const {
  const fs::path columns = local_->columns_path(sha256);
  if (is_there(columns)) {
    (void)::utimensat(AT_FDCWD, columns.c_str(), nullptr, 0);
    return columns;
  }
  for (const auto& [kind, path] : files_of_columns(columns)) {
    fetch(std::string(sha256), kind, path);
  }
  return columns;
}

/// Whoever opens the path where nothing could be fetched is told that there is nothing.
void DatabaseBlobs::fetch(const std::string& sha256, std::string_view kind, const fs::path& path) const {
  const std::lock_guard<std::mutex> guard(fetching_);
  if (is_there(path)) {
    (void)::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
    return;
  }
  make_room(sha256);
  Status fetched = fetch_into(sha256, kind, path);
  for (int attempt = 1; attempt < kAttempts && !fetched && fetched.error().code == ErrorCode::Io; ++attempt) {
    std::this_thread::sleep_for(kPause);
    fetched = fetch_into(sha256, kind, path);
  }
}

Status DatabaseBlobs::fetch_into(const std::string& sha256, std::string_view kind, const fs::path& path) const {
  struct Found {
    std::int64_t id = 0;
    std::string sha256;
  };
  const auto found = database_.read([&](Connection& connection) -> Result<std::optional<Found>> {
    Statement statement = connection.prepare(kKnown);
    statement.bind(sha256, kind);
    const auto row = statement.step();
    if (!row) {
      return fail(row.error());
    }
    return *row ? std::optional(Found{statement.integer(0), statement.text(1)}) : std::nullopt;
  });
  if (!found) {
    return fail(found.error());
  }
  const std::optional<Found>& file = *found;
  if (!file) {
    return fail(ErrorCode::NotFound, "The database has no such file.", {{"blob", sha256}});
  }
  if (Status made = make_directories(path.parent_path()); !made) {
    return made;
  }
  const fs::path temporary = root_ / "incoming" / ("fetched-" + sha256 + "." + std::string(kind));
  Sha256 digest;
  {
    std::ofstream stream(temporary, std::ios::binary | std::ios::trunc);
    for (std::int64_t number = 0;; ++number) {
      const auto part = database_.read([&](Connection& connection) -> Result<std::optional<std::string>> {
        Statement statement = connection.prepare(kPart);
        statement.bind(file->id, number);
        const auto row = statement.step();
        if (!row) {
          return fail(row.error());
        }
        return *row ? from_base64(statement.text(0)) : std::nullopt;
      });
      if (!part) {
        return fail(part.error());
      }
      const std::optional<std::string>& bytes = *part;
      if (!bytes) {
        break;
      }
      digest.update(std::as_bytes(std::span(bytes->data(), bytes->size())));
      stream.write(bytes->data(), static_cast<std::streamsize>(bytes->size()));
    }
    stream.close();
    if (!stream) {
      (void)remove_file(temporary);
      return fail(file_error(errno == 0 ? EIO : errno, "write", temporary));
    }
  }
  if (digest.finish() != file->sha256) {
    (void)remove_file(temporary);
    return fail(ErrorCode::Io, "A file in the database is damaged.", {{"blob", sha256}, {"file", std::string(kind)}});
  }
  return rename_durably(temporary, path);
}

/// Of the local copies those that were used longest ago go until the rest is within the budget.
void DatabaseBlobs::make_room(const std::string& sha256) const {
  struct Copy {
    fs::file_time_type used;
    std::uintmax_t bytes = 0;
    std::string blob;
  };
  std::vector<Copy> copies;
  std::uintmax_t total = 0;
  for (const char* folder : {"blobs", "columns"}) {
    std::error_code error;
    fs::recursive_directory_iterator entry(root_ / folder, error);
    for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
      std::error_code gone;
      const std::uintmax_t bytes = entry->is_regular_file(gone) ? entry->file_size(gone) : 0;
      const auto used = entry->last_write_time(gone);
      const std::string name = entry->path().filename().string().substr(0, 64);
      if (!gone && is_sha256_hex(name)) {
        copies.push_back({used, bytes, name});
        total += bytes;
      }
    }
  }
  std::sort(copies.begin(), copies.end(), [](const Copy& a, const Copy& b) { return a.used < b.used; });
  const auto newest = fs::file_time_type::clock::now() - kJustUsed;
  for (auto copy = copies.begin(); copy != copies.end() && total > cache_bytes_ && copy->used < newest; ++copy) {
    if (copy->blob != sha256 && local_->remove(copy->blob)) {
      for (const Copy& each : copies) {
        total -= each.blob == copy->blob ? std::min(total, each.bytes) : 0;
      }
    }
  }
}

Status DatabaseBlobs::store_files(const std::string& sha256) {
  Status stored = store_file(sha256, "bytes", local_->bytes_path(sha256));
  crash_point("upload.kept_bytes");
  for (const auto& [kind, path] : files_of_columns(local_->columns_path(sha256))) {
    if (stored && is_there(path)) {
      stored = store_file(sha256, kind, path);
    }
  }
  return stored;
}

Status DatabaseBlobs::store_file(const std::string& sha256, std::string_view kind, const fs::path& path) {
  Sha256 digest;
  std::int64_t bytes = 0;
  Status read = for_each_part(path, [&](std::span<const std::byte> part) {
    digest.update(part);
    bytes += static_cast<std::int64_t>(part.size());
    return Status{};
  });
  if (!read) {
    return read;
  }
  const std::string content = digest.finish();
  // Where the database has it already, it counts as new again for the sweeper.
  const auto known = database_.write(WriteKind::Serial, [&](Connection& connection) -> Result<bool> {
    std::int64_t id = 0;
    {
      Statement statement = connection.prepare(kKnown);
      statement.bind(sha256, kind);
      const auto row = statement.step();
      if (!row) {
        return fail(row.error());
      }
      if (!*row || statement.text(1) != content) {
        return false;
      }
      id = statement.integer(0);
    }
    const Status marked = connection.prepare(kAsNew).bind(id, database_.now(connection)).run();
    return marked ? Result<bool>(true) : fail(marked.error());
  });
  if (!known || *known) {
    return known ? Status{} : fail(known.error());
  }
  const auto id = database_.write(WriteKind::Fenced, [&](Connection& connection) -> Result<std::int64_t> {
    Statement statement = connection.prepare(kBegin);
    statement.bind(sha256, database_.now(connection));
    const auto row = statement.step();
    return row ? Result<std::int64_t>(statement.integer(0)) : fail(row.error());
  });
  if (!id) {
    return fail(id.error());
  }
  std::int64_t number = 0;
  Status written = for_each_part(path, [&](std::span<const std::byte> part) {
    const std::string text = to_base64(part);
    return database_
        .write(WriteKind::Fenced,
               [&](Connection& connection) -> Result<int> {
                 const Status added = connection.prepare(kAddPart).bind(*id, number, text).run();
                 return added ? Result<int>(0) : fail(added.error());
               })
        .map([&](int) { ++number; });
  });
  if (!written) {
    return written;
  }
  return database_
      .write(WriteKind::Serial,
             [&](Connection& connection) -> Result<int> {
               Status ended = connection.prepare(kReplace).bind(sha256, kind).run();
               if (ended) {
                 ended = connection.prepare(kEnd).bind(*id, kind, bytes, content, database_.now(connection)).run();
               }
               return ended ? Result<int>(0) : fail(ended.error());
             })
      .map([](int) {});
}

Status DatabaseBlobs::remove(std::string_view sha256) {
  if (!is_sha256_hex(sha256)) {
    return fail(ErrorCode::InvalidArgument, "A blob is named by 64 hexadecimal digits.", {{"parameter", "sha256"}});
  }
  const auto removed = database_.write(WriteKind::Serial, [&](Connection& connection) -> Result<int> {
    const Status gone = connection.prepare(kRemove).bind(sha256).run();
    return gone ? Result<int>(0) : fail(gone.error());
  });
  return removed ? local_->remove(sha256) : fail(removed.error());
}

Result<bool> DatabaseBlobs::remove_if_older(std::string_view sha256, std::chrono::microseconds age) {
  auto removed = database_.write(WriteKind::Serial, [&](Connection& connection) -> Result<bool> {
    const Status gone = connection.prepare(kRemoveOld).bind(sha256, database_.now(connection) - age.count()).run();
    return gone ? Result<bool>(connection.changes() > 0) : fail(gone.error());
  });
  if (!removed || !*removed) {
    return removed;
  }
  return local_->remove(sha256).map([] { return true; });
}

Result<std::vector<std::string>> DatabaseBlobs::hashes_older_than(std::chrono::microseconds age) {
  return database_.write(WriteKind::Serial, [&](Connection& connection) -> Result<std::vector<std::string>> {
    const UtcMicros before = database_.now(connection) - age.count();
    if (Status gone = connection.prepare(kRemoveUnfinished).bind(before).run(); !gone) {
      return fail(gone.error());
    }
    std::vector<std::string> hashes;
    Statement statement = connection.prepare(kOld);
    statement.bind(before);
    while (true) {
      const auto row = statement.step();
      if (!row || !*row) {
        return row ? Result<std::vector<std::string>>(std::move(hashes)) : fail(row.error());
      }
      hashes.push_back(statement.text(0));
    }
  });
}

}  // namespace driftlab::server
