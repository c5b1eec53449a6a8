#include "server/jobs/maintenance.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::server {
namespace {

constexpr UtcMicros kOrphanAgeMicros = 24LL * 3600 * 1'000'000;

}  // namespace

Result<int> sweep_blobs(Store& store, BlobStore& blobs, UtcMicros now) {
  const UtcMicros before = now - kOrphanAgeMicros;
  const Result<std::vector<std::string>> files = blobs.hashes_older_than(before);
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
    const Result<bool> gone = blobs.remove_if_older(file, before);
    if (!gone) {
      return fail(gone.error());
    }
    removed += *gone ? 1 : 0;
  }
  return removed;
}

Maintenance::Maintenance(Store& store, BlobStore& blobs, const Clock& clock, MaintenanceOptions options,
                         std::function<void()> rescued)
    : store_(store), blobs_(blobs), clock_(clock), options_(options), rescued_(std::move(rescued)) {}

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
  auto tidied_at = std::chrono::steady_clock::now() - std::chrono::microseconds(options_.tidy_micros);
  std::unique_lock<std::mutex> guard(mutex_);
  while (!stopping_) {
    guard.unlock();
    if (store_.rescue_expired().value_or(0) > 0 && rescued_) {
      rescued_();
    }
    if (std::chrono::steady_clock::now() - tidied_at >= std::chrono::microseconds(options_.tidy_micros)) {
      tidied_at = std::chrono::steady_clock::now();
      (void)store_.forget_old_replies();
      (void)sweep_blobs(store_, blobs_, clock_.now());
    }
    guard.lock();
    stopped_.wait_for(guard, std::chrono::microseconds(options_.rescue_micros), [this] { return stopping_; });
  }
}

}  // namespace driftlab::server
