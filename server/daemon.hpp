#pragma once
/// The daemon as one object: store, blobs, workers and HTTP, started in that order and stopped in the other.
#include "core/signal/result.hpp"
#include "server/settings.hpp"

#include <chrono>
#include <memory>

namespace driftlab::server {

class Daemon {
 public:
  /// Opens the data directory and starts everything. Errors: those of the store, the blob directory and the listener.
  [[nodiscard]] static Result<std::unique_ptr<Daemon>> start(const Settings& settings);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;
  ~Daemon();

  [[nodiscard]] std::uint16_t port() const;
  /// Whether requests are taken up: an I/O thread does something in that time. Thread safe.
  [[nodiscard]] bool is_alive(std::chrono::milliseconds patience) const;
  /// Not ready, stop accepting, finish requests (10 s), stop workers (20 s), close the store. Idempotent.
  void stop();
  /// Opens the log file again, reads the certificate again and shows it to new connections (SIGHUP); one that does not
  /// hold leaves the old one in place, and the log says why. Thread safe.
  void reload();

 private:
  struct Parts;
  explicit Daemon(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace driftlab::server
