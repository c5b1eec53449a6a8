#pragma once
/// How many transactions were acknowledged, kept beside the database: a database that is older than that has lost some,
/// as one whose write-ahead log was cut or taken away.
///
/// The database counts its own commits in the table `commits`; the file `driftlab.commits` has the count of the last
/// one whose outcome was told. It is written and not flushed: it outlives the process, and after a power cut it may be
/// behind the database, which flushes its log, and then proves nothing. It is never ahead of what was acknowledged.
#include "core/signal/result.hpp"
#include "server/store/files.hpp"
#include "server/store/sqlite/connection.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

namespace driftlab::server {

/// Belongs to the thread that writes.
class CommitLog {
 public:
  /// For the database of `connection` at `database`, after its migrations. Errors: Io, DiskFull.
  [[nodiscard]] static Result<std::unique_ptr<CommitLog>> open(const std::filesystem::path& database,
                                                               SqliteConnection& connection);

  /// Transactions that were acknowledged and are not in the database, as opening found it.
  [[nodiscard]] std::int64_t lost() const { return lost_; }

  /// Before a transaction, and before the connection that writes is closed: that the write-ahead log is the file that
  /// was written and has the length that it had. To write behind a cut would leave a hole, and a checkpoint would copy
  /// it, or half of what is left, over good pages: there is none from then on. A log that was taken away is still open
  /// here, and goes into the database before nothing more is written. Error: Io, from then on.
  [[nodiscard]] Status require_whole_log(SqliteConnection& connection);
  /// Within a transaction that changed something: counts it.
  [[nodiscard]] Status count(SqliteConnection& connection);
  /// After the commit and before anybody is told.
  void note_committed();

 private:
  /// A file as it was left.
  struct Seen {
    std::uint64_t inode = 0;
    std::int64_t bytes = 0;
  };

  CommitLog(std::filesystem::path log, FileHandle beside) : log_(std::move(log)), beside_(std::move(beside)) {}
  [[nodiscard]] std::optional<Seen> look() const;
  [[nodiscard]] std::int64_t read() const;

  const std::filesystem::path log_;
  FileHandle beside_;
  std::optional<Seen> seen_;
  std::int64_t counted_ = 0;
  std::int64_t lost_ = 0;
  bool cut_ = false;
};

}  // namespace driftlab::server
