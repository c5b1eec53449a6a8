#pragma once
/// Requests to the objects of one bucket: signed, sent again where that may help, and refused in one sentence.
///
/// A connection that breaks, a deadline that passes, and the answers 408, 429, 500, 502, 503 and 504 are tried again
/// with full jitter over 0.2 s, 0.4 s, ..., or after the pause that the storage asks for. Every request may be sent
/// twice. A clock that differs from the storage's is corrected by the date of its answers. Thread safe.
#include "server/store/s3/connection.hpp"
#include "server/store/s3/place.hpp"
#include "server/store/s3/signature.hpp"

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace driftlab::server::s3 {

struct ClientOptions {
  Patience patience;
  int attempts = 5;
  std::chrono::milliseconds first_pause{200};
  std::chrono::milliseconds longest_pause{20'000};
  std::chrono::milliseconds in_all{60'000};  ///< after that nothing is sent again
};

/// A request to an object, or to the bucket where `key` is empty.
struct Call {
  std::string verb;
  std::string key;
  Pairs query;
  Pairs headers;
  std::span<const std::byte> body;
};

class Client {
 public:
  /// Asked before each request, for keys change while a daemon runs. Errors: InvalidArgument, NotFound, Io.
  using KeyRing = std::function<Result<Credentials>()>;

  Client(Place place, KeyRing keys, ClientOptions options = {});
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  ~Client();

  /// An answer of the status 2xx. With a sink there is one attempt alone: what it took cannot be taken back.
  /// Errors: NotFound where there is no such object; DiskFull where the storage has no room or a quota is reached; Io
  /// for everything else, with the field `storage`; those of the sink and of the key ring.
  [[nodiscard]] Result<Reply> send(const Call& call, const Connection::Sink& sink = {}) const;
  /// The same, once.
  [[nodiscard]] Result<Reply> send_once(const Call& call) const;

  [[nodiscard]] const Place& place() const { return place_; }

 private:
  struct Outcome {
    Result<Reply> reply;
    bool again = false;
    std::chrono::milliseconds pause{0};  ///< as the storage asks for; 0: it does not
  };

  [[nodiscard]] Outcome attempt(const Call& call, const Connection::Sink& sink) const;
  [[nodiscard]] Outcome judge(const Call& call, Reply reply) const;
  [[nodiscard]] Result<Reply> exchange(const Request& request, const Connection::Sink& sink) const;
  [[nodiscard]] std::unique_ptr<Connection> take_open() const;

  Place place_;
  KeyRing keys_;
  ClientOptions options_;
  Connector connector_;
  mutable std::atomic<std::int64_t> ahead_micros_{0};  ///< of the storage's clock before ours
  mutable std::mutex idle_mutex_;
  mutable std::vector<std::unique_ptr<Connection>> idle_;
};

/// `Tue, 27 Mar 2007 19:36:42 GMT` or `2007-03-27T19:36:42.000Z`. Nothing for another text.
[[nodiscard]] std::optional<UtcMicros> read_time(const std::string& text);

}  // namespace driftlab::server::s3
