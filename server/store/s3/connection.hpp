#pragma once
/// One connection to an object storage by HTTP/1.1, kept open between requests. Each step has a deadline; not thread
/// safe.
///
/// HTTPS verifies certificate chain and host name by OpenSSL against the system's authorities (SSL_CERT_FILE names
/// others). A redirect is an answer like any other and is not followed.
#include "server/store/s3/place.hpp"
#include "server/store/s3/signature.hpp"

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace driftlab::server::s3 {

/// A storage that takes longer than this does not answer.
struct Patience {
  std::chrono::milliseconds connecting{10'000};  ///< with name and TLS
  std::chrono::milliseconds answering{30'000};   ///< until the header has come, after a body is sent
  std::chrono::milliseconds moving{30'000};      ///< a body's first bytes
  std::size_t bytes_per_second = 65'536;         ///< at least, of a body on top of that
};

struct Request {
  std::string verb;
  std::string target;  ///< encoded path and query
  Pairs headers;
  std::span<const std::byte> body;
};

struct Reply {
  int status = 0;
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;                            ///< at most 16 MiB; empty where a sink took it
  /// Of that name, in lower case; empty: there is none.
  [[nodiscard]] std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? std::string() : found->second;
  }
};

class Connection {
 public:
  using Sink = std::function<Status(std::span<const std::byte>)>;

  Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  virtual ~Connection();
  /// Sends a request and reads its answer; the body of a 2xx goes to `sink` where there is one. Errors: Io, in words
  /// that follow the storage's name ("did not answer: it took too long"); those of the sink.
  [[nodiscard]] virtual Result<Reply> exchange(const Request& request, const Sink& sink) = 0;
  /// Whether another request may follow.
  [[nodiscard]] virtual bool is_open() const = 0;
};

/// What connections of one storage have in common: the certificates to trust, read once.
class Connector {
 public:
  Connector(Place place, Patience patience);
  Connector(const Connector&) = delete;
  Connector& operator=(const Connector&) = delete;
  ~Connector();
  /// Errors: Io, in words that follow the storage's name.
  [[nodiscard]] Result<std::unique_ptr<Connection>> connect() const;

 private:
  struct Trust;
  Place place_;
  Patience patience_;
  std::unique_ptr<Trust> trust_;
};

}  // namespace driftlab::server::s3
