#include "server/store/postgres/database_files.hpp"

#include "server/store/base64.hpp"
#include "server/store/digest.hpp"
#include "server/store/files.hpp"

#include <cerrno>
#include <fstream>
#include <utility>

namespace driftlab::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPartBytes = 1U << 20U;

constexpr std::string_view kKnown = "SELECT id, sha256 FROM stored_files WHERE blob = ?1 AND kind = ?2";
constexpr std::string_view kBegin =
    "INSERT INTO stored_files (blob, written_at) VALUES (?1, CAST(?2 AS BIGINT)) RETURNING id";
constexpr std::string_view kAddPart =
    "INSERT INTO stored_file_parts (file_id, number, content) VALUES (?1, ?2, decode(?3, 'base64'))";
constexpr std::string_view kReplace = "DELETE FROM stored_files WHERE blob = ?1 AND kind = ?2";
constexpr std::string_view kEnd =
    "UPDATE stored_files SET kind = ?2, bytes = ?3, sha256 = ?4, written_at = ?5 WHERE id = ?1";
constexpr std::string_view kAsNew = "UPDATE stored_files SET written_at = ?2 WHERE id = ?1 AND kind IS NOT NULL";
constexpr std::string_view kPart =
    "SELECT encode(content, 'base64') FROM stored_file_parts WHERE file_id = ?1 AND number = ?2";
constexpr std::string_view kRemove = "DELETE FROM stored_files WHERE blob = ?1";
constexpr std::string_view kRemoveOld =
    "DELETE FROM stored_files WHERE blob = ?1 AND NOT EXISTS (SELECT 1 FROM stored_files AS newer WHERE newer.blob = "
    "?1 AND newer.written_at >= ?2)";
constexpr std::string_view kRemoveUnfinished = "DELETE FROM stored_files WHERE kind IS NULL AND written_at < ?1";
constexpr std::string_view kOld =
    "SELECT DISTINCT blob FROM stored_files WHERE kind IS NOT NULL AND written_at < ?1 ORDER BY blob";

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

}  // namespace

Result<std::optional<DatabaseFiles::Known>> DatabaseFiles::find(const std::string& blob, FileKind kind) const {
  return database_.read([&](Connection& connection) -> Result<std::optional<Known>> {
    Statement statement = connection.prepare(kKnown);
    statement.bind(blob, kind);
    const auto row = statement.step();
    if (!row) {
      return fail(row.error());
    }
    return *row ? std::optional(Known{statement.integer(0), statement.text(1)}) : std::nullopt;
  });
}

Status DatabaseFiles::read_parts(std::int64_t id, const Sink& sink) const {
  for (std::int64_t number = 0;; ++number) {
    const auto part = database_.read([&](Connection& connection) -> Result<std::optional<std::string>> {
      Statement statement = connection.prepare(kPart);
      statement.bind(id, number);
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
      return {};
    }
    if (Status taken = sink(std::as_bytes(std::span(bytes->data(), bytes->size()))); !taken) {
      return taken;
    }
  }
}

Result<std::string> DatabaseFiles::read(const std::string& blob, FileKind kind, const Sink& sink) const {
  const auto found = find(blob, kind);
  if (!found) {
    return fail(found.error());
  }
  const std::optional<Known>& file = *found;
  if (!file) {
    return fail(ErrorCode::NotFound, "The database has no such file.", {{"blob", blob}});
  }
  return read_parts(file->id, sink).map([&] { return file->sha256; });
}

Status DatabaseFiles::store(const std::string& blob, std::span<const LocalFile> files) {
  for (const LocalFile& file : files) {
    if (Status stored = store_file(blob, file); !stored) {
      return stored;
    }
  }
  return {};
}

/// Whether the parts of a file are what was written.
Result<bool> DatabaseFiles::holds(const Known& known) const {
  Sha256 digest;
  const Status read = read_parts(known.id, [&](std::span<const std::byte> bytes) -> Status {
    digest.update(bytes);
    return {};
  });
  return read ? Result<bool>(digest.finish() == known.sha256) : fail(read.error());
}

/// For the sweeper. False: it is gone.
Result<bool> DatabaseFiles::mark_as_new(const Known& known) {
  return database_.write(WriteKind::Serial, [&](Connection& connection) -> Result<bool> {
    const Status marked = connection.prepare(kAsNew).bind(known.id, database_.now(connection)).run();
    return marked ? Result<bool>(connection.changes() > 0) : fail(marked.error());
  });
}

Status DatabaseFiles::store_file(const std::string& blob, const LocalFile& file) {
  Sha256 digest;
  std::int64_t bytes = 0;
  Status read = for_each_part(file.path, [&](std::span<const std::byte> part) {
    digest.update(part);
    bytes += static_cast<std::int64_t>(part.size());
    return Status{};
  });
  if (!read) {
    return read;
  }
  const std::string content = digest.finish();
  const auto known = find(blob, file.kind);
  if (!known) {
    return fail(known.error());
  }
  if (const std::optional<Known>& one = *known; one && one->sha256 == content) {
    const auto sound = holds(*one);
    const auto marked = sound && *sound ? mark_as_new(*one) : sound;
    if (!marked || *marked) {
      return marked ? Status{} : fail(marked.error());
    }
  }
  const auto id = database_.write(WriteKind::Fenced, [&](Connection& connection) -> Result<std::int64_t> {
    Statement statement = connection.prepare(kBegin);
    statement.bind(blob, database_.now(connection));
    const auto row = statement.step();
    return row ? Result<std::int64_t>(statement.integer(0)) : fail(row.error());
  });
  if (!id) {
    return fail(id.error());
  }
  std::int64_t number = 0;
  Status written = for_each_part(file.path, [&](std::span<const std::byte> part) {
    const std::string text = to_base64({reinterpret_cast<const char*>(part.data()), part.size()});
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
               Status ended = connection.prepare(kReplace).bind(blob, file.kind).run();
               if (ended) {
                 ended = connection.prepare(kEnd).bind(*id, file.kind, bytes, content, database_.now(connection)).run();
               }
               return ended ? Result<int>(0) : fail(ended.error());
             })
      .map([](int) {});
}

Status DatabaseFiles::remove(const std::string& blob) {
  return database_
      .write(WriteKind::Serial,
             [&](Connection& connection) -> Result<int> {
               const Status gone = connection.prepare(kRemove).bind(blob).run();
               return gone ? Result<int>(0) : fail(gone.error());
             })
      .map([](int) {});
}

Result<bool> DatabaseFiles::remove_if_older(const std::string& blob, std::chrono::microseconds age) {
  return database_.write(WriteKind::Serial, [&](Connection& connection) -> Result<bool> {
    const Status gone = connection.prepare(kRemoveOld).bind(blob, database_.now(connection) - age.count()).run();
    return gone ? Result<bool>(connection.changes() > 0) : fail(gone.error());
  });
}

Result<std::vector<std::string>> DatabaseFiles::hashes_older_than(std::chrono::microseconds age) {
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
