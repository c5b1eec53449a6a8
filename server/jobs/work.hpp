#pragma once
/// What a worker is at: an attempt at a job of its own, or help with one of others.
#include "core/signal/progress.hpp"
#include "server/store/store.hpp"

#include <stop_token>

namespace driftlab::server {

class Work {
 public:
  Work() = default;
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;
  virtual ~Work() = default;

  /// In the worker's thread, to the end.
  virtual void run() = 0;

  // From other threads, meanwhile.
  /// What a beat of the heart does for it; `renew`: leases are due.
  virtual void tend(bool renew) = 0;
  /// The daemon is stopping: it is to end.
  virtual void ask_to_stop() = 0;
  /// The time to end is over: what it holds goes back now, and what it still finds is discarded.
  virtual void hand_back() = 0;
};

/// The control of work that counts against that attempt, also where another thread of the executor helps with it. It
/// reports no progress. References must outlive it.
[[nodiscard]] RunControl charged_to(const Lease& lease, Executor& executor, std::stop_token stop);

}  // namespace driftlab::server
