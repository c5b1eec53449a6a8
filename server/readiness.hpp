#pragma once
/// Whether this daemon can take work: its store answers and can be written, and its disk has room.
#include "server/store/blobs.hpp"
#include "server/store/store.hpp"

#include <chrono>
#include <mutex>
#include <optional>
#include <string>

namespace driftlab::server {

/// Any thread may ask.
class Readiness {
 public:
  /// Both must outlive it.
  Readiness(Store& store, BlobStore& blobs) : store_(store), blobs_(blobs) {}

  /// A sentence; empty where the daemon can take work.
  [[nodiscard]] std::string why_not() const;

  /// Less than 5 % and less than 10 GiB of the disk are free, or nobody can say.
  [[nodiscard]] bool is_nearly_full() const;

 private:
  /// Why a row cannot be written; tried once in two seconds, for who asks whether the daemon is ready asks often. A bad
  /// state is logged when it begins and when it ends.
  [[nodiscard]] std::string cannot_write_why() const;

  Store& store_;
  BlobStore& blobs_;
  mutable std::mutex mutex_;
  mutable std::optional<std::chrono::steady_clock::time_point> probed_at_;
  mutable std::string write_fault_;
};

}  // namespace driftlab::server
