#pragma once
/// The bad states of this daemon: each is reported once when it begins and once when it ends, and shown while it lasts.
///
/// Each begin and end goes to a listener (the log) at once and to the audit log as soon as that can be written: a store
/// that cannot be written says so afterwards. Thread safe.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"

#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::server {

enum class BadState {
  StoreSilent,      ///< the database does not answer
  StoreUnwritable,  ///< a row cannot be written
  BlobsSilent,      ///< the storage of recordings, where it is no folder, does not answer
  DiskNearlyFull,   ///< less than 5 % and less than 10 GiB are free
  FilesFail,        ///< an answer or a job met an error of the disk in the last minutes
  FileDamaged,      ///< a stored file is not what was written
  RowDamaged,       ///< a row of the database is not
  BackupsFail,      ///< the last backup failed, or found damage
  WritesLost,       ///< the database is older than what was acknowledged, as this process found it
};

/// `store_silent`, ...
[[nodiscard]] std::string_view name_of(BadState state);
[[nodiscard]] const std::vector<BadState>& all_bad_states();
/// Why a state can be: `io`, `disk_full`, `damage`.
[[nodiscard]] const std::vector<std::string_view>& causes_of_bad_states();
[[nodiscard]] std::string_view cause_of(const Error& error);

struct StandingState {
  BadState state = BadState::StoreSilent;
  std::string object;  ///< hash of the file, or `table/key` of the row, that is damaged; else empty
  std::string_view cause;
  std::string detail;  ///< one sentence, with the paths of files
  UtcMicros since = 0;
};

class BadStates {
 public:
  /// Told of each begin and end. On the thread that found it.
  using Listener = std::function<void(const StandingState& state, bool begins)>;
  /// Writes a row of the audit log.
  using Recorder =
      std::function<Status(const std::string& action, const std::string& object, const std::string& detail)>;

  /// `clock` must outlive this object.
  BadStates(const Clock& clock, Listener listener, Recorder recorder)
      : clock_(clock), listener_(std::move(listener)), recorder_(std::move(recorder)) {}

  /// Says so if it was not known. The same state for another cause is another one.
  void begin(BadState state, std::string_view cause, std::string detail, std::string object = {});
  void end(BadState state, const std::string& object = {});
  /// FilesFail ends when nothing has failed for five minutes.
  void note_failure(const Error& error);

  [[nodiscard]] std::vector<StandingState> standing() const;

  /// To be called periodically: ends states that have passed, and writes the rows of the audit log that are due.
  /// Blocks.
  void look_after();

 private:
  struct Row {
    std::string action;
    std::string object;
    std::string detail;
  };
  using Key = std::pair<BadState, std::string>;

  void take_out(std::map<Key, StandingState>::iterator found);

  const Clock& clock_;
  const Listener listener_;
  const Recorder recorder_;
  mutable std::mutex mutex_;
  std::map<Key, StandingState> standing_;
  std::vector<Row> due_;
  UtcMicros failed_at_ = 0;
};

}  // namespace driftlab::server
