#include "server/store/sqlite/commit_log.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <string>

namespace driftlab::server {
namespace {

constexpr std::string_view kCommits = "SELECT number FROM commits";
constexpr std::string_view kCount = "UPDATE commits SET number = number + 1 RETURNING number";
constexpr std::string_view kGoOnFrom = "UPDATE commits SET number = ?";
constexpr std::size_t kDigits = 20;  // as many for every number, so that a write never leaves a part of another

std::filesystem::path beside(const std::filesystem::path& database, const char* ending) {
  std::filesystem::path path = database;
  path.replace_extension(ending);
  return path;
}

}  // namespace

Result<std::unique_ptr<CommitLog>> CommitLog::open(const std::filesystem::path& database,
                                                   SqliteConnection& connection) {
  const std::filesystem::path path = beside(database, ".commits");
  FileHandle file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (!file) {
    return fail(file_error(errno, "open", path));
  }
  std::filesystem::path log = database;
  log += "-wal";
  std::unique_ptr<CommitLog> opened(new CommitLog(std::move(log), std::move(file)));
  const auto counted = connection.query_integer(kCommits);
  if (!counted) {
    return fail(counted.error());
  }
  opened->counted_ = counted->value_or(0);
  const std::int64_t acknowledged = opened->read();
  opened->lost_ = std::max<std::int64_t>(0, acknowledged - opened->counted_);
  if (opened->lost_ > 0) {
    // Numbers go on behind those that are gone, so that the next loss is told from this one.
    if (Status done = connection.prepare(kGoOnFrom).bind(acknowledged).run(); !done) {
      return fail(done.error());
    }
    opened->counted_ = acknowledged;
  }
  opened->note_committed();
  return opened;
}

std::optional<CommitLog::Seen> CommitLog::look() const {
  struct stat found{};
  if (::stat(log_.c_str(), &found) != 0) {
    return std::nullopt;
  }
  return Seen{static_cast<std::uint64_t>(found.st_ino), static_cast<std::int64_t>(found.st_size)};
}

std::int64_t CommitLog::read() const {
  std::array<char, kDigits> text{};
  std::int64_t number = 0;
  if (::pread(beside_.get(), text.data(), text.size(), 0) == static_cast<ssize_t>(text.size())) {
    (void)std::from_chars(text.data(), text.data() + text.size(), number);
  }
  return number;
}

Status CommitLog::require_whole_log(SqliteConnection& connection) {
  if (!cut_ && seen_) {
    const std::optional<Seen> now = look();
    const bool taken_away = !now || now->inode != seen_->inode;
    cut_ = taken_away || now->bytes < seen_->bytes;
    if (taken_away) {
      (void)connection.execute("PRAGMA wal_checkpoint(FULL)");
    }
    if (cut_) {
      connection.leave_log_on_close();
    }
  }
  if (cut_) {
    return fail(ErrorCode::Io,
                "The write-ahead log of the database was cut or taken away while it was open; nothing more is written, "
                "so that what is left stays as it is. Keep a copy of the directory, and start the daemon again.",
                {{"path", log_.string()}});
  }
  return {};
}

Status CommitLog::count(SqliteConnection& connection) {
  Statement statement = connection.prepare(kCount);
  const Result<bool> row = statement.step();
  if (!row) {
    return fail(row.error());
  }
  counted_ = *row ? statement.integer(0) : counted_ + 1;
  return statement.run();
}

void CommitLog::note_committed() {
  std::array<char, kDigits + 1> text{};
  (void)std::snprintf(text.data(), text.size(), "%020lld", static_cast<long long>(counted_));
  (void)!::pwrite(beside_.get(), text.data(), kDigits, 0);  // one that cannot be written proves less, and harms nothing
  seen_ = look();
}

}  // namespace driftlab::server
