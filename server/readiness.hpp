#pragma once
/// Whether this daemon can take work: its store answers and can be written, so does the storage of its recordings, and
/// its disk has room.
#include "server/store/bad_states.hpp"
#include "server/store/blobs.hpp"
#include "server/store/store.hpp"

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>

namespace driftlab::server {

/// Any thread may ask.
class Readiness {
 public:
  /// All must outlive it. What is found wrong begins and ends in `states`.
  Readiness(Store& store, BlobStore& blobs, BadStates& states) : store_(store), blobs_(blobs), states_(states) {}

  /// A sentence that names state and cause, without paths of files; empty where the daemon can take work.
  [[nodiscard]] std::string why_not() const;

  /// The same checks, to be run periodically without a request. A row is written as a test only while something is
  /// wrong, so that an idle daemon does not use the disk.
  void look_after() const;

  /// Less than 5 % and less than 10 GiB of the disk are free, or the free space is unknown.
  [[nodiscard]] bool is_nearly_full() const;

 private:
  /// A question that is asked no more often than once in its interval, for who asks whether the daemon is ready asks
  /// often; meanwhile the last answer holds.
  class Probe {
   public:
    explicit Probe(std::chrono::seconds interval) : interval_(interval) {}
    [[nodiscard]] Status ask(const std::function<Status()>& question);

   private:
    std::chrono::seconds interval_;
    std::mutex mutex_;
    std::optional<std::chrono::steady_clock::time_point> asked_at_;
    Status answer_;
  };

  [[nodiscard]] std::string look(bool tries_to_write) const;
  /// The sentence for a state that holds where `checked` failed; empty where it does not.
  [[nodiscard]] std::string told(BadState state, const std::string& what, const Status& checked) const;

  Store& store_;
  BlobStore& blobs_;
  BadStates& states_;
  mutable Probe writable_{std::chrono::seconds(2)};   ///< whether a row can be written
  mutable Probe reachable_{std::chrono::seconds(5)};  ///< whether the storage of recordings answers
};

}  // namespace driftlab::server
