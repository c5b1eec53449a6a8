#include "server/jobs/maintenance.hpp"

#include "server/store/damaged_row.hpp"
#include "server/store/guarded_round.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::server {
namespace {

constexpr std::int64_t kDayMicros = 24LL * 3600 * 1'000'000;

/// Whether so much time has passed since `done_at`, which is now then.
bool is_due(std::chrono::steady_clock::time_point& done_at, std::int64_t micros) {
  const auto now = std::chrono::steady_clock::now();
  if (now - done_at < std::chrono::microseconds(micros)) {
    return false;
  }
  done_at = now;
  return true;
}

/// A removal, once more where the disk is full and space could be given back: removing writes to the log first.
template <class Removal>
auto with_room(const MaintenanceOptions& options, const Removal& removal) {
  auto removed = removal();
  if (!removed && removed.error().code == ErrorCode::DiskFull && options.make_room && options.make_room()) {
    removed = removal();
  }
  return removed;
}

/// False: it stays.
Result<bool> expire(Store& store, const MaintenanceOptions& options, const StoredRecording& recording) {
  const Status gone = with_room(options, [&] { return store.expire_recording(recording.id); });
  if (!gone) {
    const bool stays = gone.error().code == ErrorCode::Conflict || gone.error().code == ErrorCode::NotFound ||
                       !damaged_row_of(gone.error()).empty();
    return stays ? Result<bool>(false) : fail(gone.error());
  }
  if (options.expired) {
    options.expired(recording);
  }
  (void)store.remove_unused_blob(recording.blob_sha256);
  return true;
}

}  // namespace

Result<int> forget_old(Store& store, const MaintenanceOptions& options, UtcMicros now) {
  constexpr int kAtOnce = 100;
  const Budgets& budgets = options.budgets;
  int removed = 0;
  if (budgets.keep_jobs_days > 0) {
    const auto jobs =
        with_room(options, [&] { return store.forget_ended_jobs(now - budgets.keep_jobs_days * kDayMicros); });
    if (!jobs) {
      return fail(jobs.error());
    }
    removed += *jobs;
  }
  std::string after;
  bool any_old = budgets.keep_recordings_days > 0;
  while (any_old) {
    const auto some = store.stored_recordings(after, kAtOnce);
    if (!some) {
      return fail(some.error());
    }
    any_old = false;  // ids follow the time; one row with a wrong time ends nothing
    for (const StoredRecording& recording : *some) {
      after = recording.id;
      if (recording.created_at >= now - budgets.keep_recordings_days * kDayMicros) {
        continue;
      }
      any_old = true;
      const Result<bool> gone = expire(store, options, recording);
      if (!gone) {
        return fail(gone.error());
      }
      removed += *gone ? 1 : 0;
    }
  }
  return removed;
}

Result<int> sweep_blobs(Store& store, BlobStore& blobs, std::chrono::microseconds age) {
  const Result<std::vector<std::string>> files = blobs.hashes_older_than(age);
  if (!files) {
    return fail(files.error());
  }
  const Result<std::vector<std::string>> rows = store.blob_hashes();
  if (!rows) {
    return fail(rows.error());
  }
  std::vector<std::string> known = *rows;
  std::sort(known.begin(), known.end());
  int removed = 0;
  for (const std::string& file : *files) {
    if (std::binary_search(known.begin(), known.end(), file)) {
      continue;
    }
    const Result<bool> gone = blobs.remove_if_older(file, age);
    if (!gone) {
      return fail(gone.error());
    }
    removed += *gone ? 1 : 0;
  }
  return removed;
}

Maintenance::Maintenance(Store& store, BlobStore& blobs, const Clock& clock, MaintenanceOptions options,
                         std::function<void()> rescued)
    : store_(store), blobs_(blobs), clock_(clock), options_(std::move(options)), rescued_(std::move(rescued)) {}

Maintenance::~Maintenance() { stop(); }

void Maintenance::start() {
  thread_ = std::thread([this] { run(); });
}

void Maintenance::stop() {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    stopping_ = true;
  }
  stopped_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void Maintenance::run() {
  tidied_at_ = std::chrono::steady_clock::now() - std::chrono::microseconds(options_.tidy_micros);
  settled_at_ = std::chrono::steady_clock::now() - std::chrono::microseconds(options_.settle_micros);
  std::unique_lock<std::mutex> guard(mutex_);
  while (!stopping_) {
    guard.unlock();
    (void)guarded_round("maintenance", [this] { turn(); });
    guard.lock();
    stopped_.wait_for(guard, std::chrono::microseconds(options_.rescue_micros), [this] { return stopping_; });
  }
}

void Maintenance::forget() {
  const Result<int> removed = forget_old(store_, options_, clock_.now());
  std::string failure = removed ? std::string() : removed.error().message;
  if (!removed && failure != told_failure_ && options_.failed) {
    options_.failed(removed.error());
  }
  told_failure_ = std::move(failure);
}

void Maintenance::turn() {
  const bool mine = !options_.is_mine || options_.is_mine();
  if (mine && store_.rescue_expired().value_or(0) > 0 && rescued_) {
    rescued_();
  }
  if (mine && is_due(settled_at_, options_.settle_micros)) {
    (void)store_.settle_recordings();
  }
  const bool full = mine && options_.is_nearly_full && options_.is_nearly_full();
  if (full) {
    forget();
    (void)sweep_blobs(store_, blobs_, std::chrono::minutes(1));
  }
  if (mine && is_due(tidied_at_, options_.tidy_micros)) {
    (void)store_.forget_old_replies();
    forget();
    (void)sweep_blobs(store_, blobs_, std::chrono::hours(options_.budgets.orphan_hours));
    if (options_.each_tidy) {
      options_.each_tidy();
    }
  }
  if (options_.each_turn) {
    options_.each_turn();
  }
}

}  // namespace driftlab::server
