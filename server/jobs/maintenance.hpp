#pragma once
/// Periodic maintenance of the store: expired leases, old replies, files without rows.
#include "core/signal/result.hpp"
#include "server/store/blobs.hpp"
#include "server/store/budgets.hpp"
#include "server/store/store.hpp"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace driftlab::server {

struct MaintenanceOptions {
  std::int64_t rescue_micros = 5'000'000;    ///< between looks for expired leases
  std::int64_t settle_micros = 60'000'000;   ///< between looks for recordings that have a result by now
  std::int64_t tidy_micros = 3'600'000'000;  ///< between removals of old replies and of files without rows
  Budgets budgets = {};
  /// Whether this process does it, of several on one store; empty: it is the only one.
  std::function<bool()> is_mine = {};
  std::function<bool()> is_nearly_full = {};  ///< then what is older than it may be goes at once, with its files
  std::function<void(const StoredRecording&)> expired = {};  ///< told of each recording that went for its age
  std::function<bool()> make_room = {};           ///< gives space back, so that a full disk can be written; false: none
  std::function<void(const Error&)> failed = {};  ///< told why old rows could not be removed, once for each sentence
  std::function<void()> each_tidy = {};           ///< what else is forgotten, at each removal of old replies
  std::function<void()> each_turn = {};           ///< what else is looked after, at each look for expired leases
};

/// Removes recordings and ended jobs that are older than the budgets keep_recordings_days and keep_jobs_days say,
/// also those whose rows are damaged. A recording that a job is using stays until the next time, and one whose removal
/// meets a damaged row, which the store tells. How many. Errors: those of the store.
[[nodiscard]] Result<int> forget_old(Store& store, const MaintenanceOptions& options, UtcMicros now);

/// Blob files older than `age` that no row names, removed. How many. An upload of the same bytes at the same
/// moment keeps its file: `keep` makes a blob young again, and only old ones are removed. Errors: Io.
[[nodiscard]] Result<int> sweep_blobs(Store& store, BlobStore& blobs, std::chrono::microseconds age);

/// One thread. A task that fails is tried again at its next turn; the store's state says what is left to do. An
/// exception ends the turn alone (server/store/guarded_round.hpp).
class Maintenance {
 public:
  /// `rescued` is called when jobs went back to the queue. References must outlive this object.
  Maintenance(Store& store, BlobStore& blobs, const Clock& clock, MaintenanceOptions options,
              std::function<void()> rescued);
  Maintenance(const Maintenance&) = delete;
  Maintenance& operator=(const Maintenance&) = delete;
  ~Maintenance();

  void start();
  void stop();

 private:
  void run();
  /// One look for expired leases, and what else is due.
  void turn();
  void forget();

  Store& store_;
  BlobStore& blobs_;
  const Clock& clock_;
  const MaintenanceOptions options_;
  const std::function<void()> rescued_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stopping_ = false;
  std::chrono::steady_clock::time_point settled_at_;
  std::chrono::steady_clock::time_point tidied_at_;
  std::string told_failure_;  ///< of the last removal of old rows; empty: it was done
  std::thread thread_;
};

}  // namespace driftlab::server
