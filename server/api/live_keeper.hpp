#pragma once
/// Keeps the recordings that are still being made, for whoever began them, and finishes those that nobody adds to.
#include "schema/json/json.hpp"
#include "server/api/api.hpp"
#include "server/store/live_recordings.hpp"

#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace driftlab::server {

/// How long the secret of a live recording is good, and a recording that cannot be finished is kept.
inline constexpr UtcMicros kLiveMicros = 24LL * 3600 * 1'000'000;
/// Bytes of a piece, and of what is written at a time.
inline constexpr std::size_t kLongestLivePiece = 1024UL * 1024;
/// The column of the stamps.
inline constexpr std::string_view kLiveTime = "time";

/// Thread safe. What nobody has added to for an hour is finished as it is, at the latest six hours after a try that
/// failed; what cannot be a recording, or whose token was revoked, is dropped after a day.
class LiveKeeper {
 public:
  explicit LiveKeeper(ApiContext& context);
  LiveKeeper(const LiveKeeper&) = delete;
  LiveKeeper& operator=(const LiveKeeper&) = delete;
  ~LiveKeeper();

  [[nodiscard]] LiveRecordings& recordings() { return recordings_; }
  [[nodiscard]] ApiContext& context() { return context_; }
  /// Held while one is begun, so that those that begin at once do not pass the budgets together.
  [[nodiscard]] std::mutex& beginning() { return begin_; }

  /// Whether the token that began it is valid still.
  [[nodiscard]] bool is_admitted(const LiveRecording& recording) const;

  /// Makes a recording of what is there, for whoever began it, and queues its characterisation: `recording` and `job`,
  /// which is null where it could not be queued, or where who began it may ask for none. Errors: NotFound, NoSamples,
  /// those of record_blob.
  [[nodiscard]] Result<Json> finish(const std::string& id);

  /// One look at what nobody adds to; its own thread has one every minute.
  void finish_untouched();

 private:
  [[nodiscard]] Json characterise(const std::string& recording);
  void sweep();
  void try_to_finish(const std::string& id);

  ApiContext& context_;
  LiveRecordings recordings_;
  std::mutex begin_;
  std::mutex finish_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stopping_ = false;
  std::thread sweeper_;
};

}  // namespace driftlab::server
