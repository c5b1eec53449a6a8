#pragma once
/// Backups that the daemon makes of its own data directory, by a timer and on request. One backup is made at a time, in
/// a thread of its own, so that no request waits for it.
///
/// Each is a folder `<directory>/<name>` as `driftlabd backup` makes it (server/store/sqlite/backup.hpp), named by the
/// moment that it holds. A folder appears under that name only when its backup is complete; an unfinished one has
/// another name and does not count as a backup. The newest sound backups are kept (`BackupOptions::keep`); older ones
/// are removed after a backup that found no damage, and of the damaged ones a few stay besides. An exception ends a
/// backup as `Failed`, and the thread goes on (server/store/guarded_round.hpp).
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"
#include "server/store/store_report.hpp"

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace driftlab::server {

enum class BackupState {
  Running,
  Complete,  ///< and sound: all of it was read back
  Damaged,   ///< complete, but of a store in which something is damaged
  Failed,    ///< no backup was made
};

[[nodiscard]] std::string_view name_of(BackupState state);

/// A moment as names of backups say it.
[[nodiscard]] bool is_backup_name(std::string_view text);

struct Backup {
  std::string name;  ///< `20261125T081500Z`
  BackupState state = BackupState::Running;
  UtcMicros begun_at = 0;
  std::optional<UtcMicros> finished_at;
  std::int64_t blobs = 0;
  std::int64_t bytes = 0;             ///< of recordings and their columns
  std::vector<std::string> faults;    ///< sentences: what is damaged, or why it failed; without paths of files
  std::optional<Error> failure = {};  ///< why it failed, with them: for the log
};

struct BackupOptions {
  std::filesystem::path directory;  ///< of the backups of this daemon alone; empty: none are made
  /// Makes a backup in a folder that does not exist yet. Error: Cancelled if a stop was requested; no file is left
  /// then.
  std::function<Result<StoreReport>(const std::filesystem::path& target, const std::string& now,
                                    const std::stop_token& stop)>
      make = {};
  std::function<StoreReport(const std::filesystem::path& backup)> describe = {};  ///< a complete one; may be empty
  std::int64_t every_micros = 0;                                                  ///< 0: only when asked
  std::size_t keep = 0;                                                           ///< of sound ones; 0: all of all
  std::function<void(const Backup&)> ended = {};  ///< told of each, on the thread that made it
};

/// Thread safe.
class Backups {
 public:
  /// `clock` must outlive this object.
  Backups(const Clock& clock, BackupOptions options);
  Backups(const Backups&) = delete;
  Backups& operator=(const Backups&) = delete;
  ~Backups() { stop(); }

  /// Removes what a process that was killed left unfinished, and starts the timer: the first backup is due when the
  /// newest of the directory, sound or damaged, is old enough.
  void start();
  /// Cancels the backup under way, whose files are removed, and blocks until that is done.
  void stop();

  /// Begins a backup, or returns the one under way. Errors: Conflict (there is no directory for them); Cancelled (the
  /// daemon is stopping).
  [[nodiscard]] Result<Backup> begin();

  /// The complete backups in the directory and those of this process that are under way or failed, newest first. Error:
  /// Io.
  [[nodiscard]] Result<std::vector<Backup>> list() const;

  /// When the newest undamaged backup was begun; nothing if there is none or the daemon has no directory for backups.
  [[nodiscard]] std::optional<UtcMicros> newest() const;

  /// Since when there is no newer undamaged one: when the newest was begun, also where its folder is gone from a
  /// directory that is empty now (its disk is not mounted); where this process has seen none, when it began. Nothing:
  /// the daemon has no directory for backups.
  [[nodiscard]] std::optional<UtcMicros> none_since() const;

 private:
  /// The backups that were in the directory when some were last seen there.
  struct Seen {
    UtcMicros newest = 0;
    std::optional<UtcMicros> newest_sound;
    std::uint64_t device = 0;  ///< of the directory
  };

  [[nodiscard]] Result<std::vector<Backup>> complete() const;
  /// Io: the directory, or its disk, is not the one on which backups were seen, and has none of them.
  [[nodiscard]] Status require_its_disk() const;
  void run(const std::stop_token& stop);
  /// Makes the backup that is under way.
  void make(const std::stop_token& stop);
  void forget_old(bool sound);
  void remove_but_newest(const std::vector<Backup>& oldest_first, std::size_t keep) const;
  void forget_unfinished();
  [[nodiscard]] bool is_due() const;

  const Clock& clock_;
  const BackupOptions options_;
  const UtcMicros began_;
  mutable std::mutex mutex_;
  std::condition_variable_any asked_;
  std::vector<Backup> own_;  ///< of this process, oldest first; at most kOwn
  mutable std::optional<Seen> seen_;
  bool wanted_ = false;
  bool stopped_ = false;
  std::jthread thread_;
};

}  // namespace driftlab::server
