#pragma once
/// Idempotency keys whose requests are under way: of several requests with one key, whatever they ask, one runs.
#include <memory>
#include <mutex>
#include <set>
#include <string>

namespace driftlab::server {

class KeysInFlight {
 public:
  /// Holds a key until it is destroyed.
  class Flight {
   public:
    Flight(KeysInFlight& keys, std::string key) : keys_(keys), key_(std::move(key)) {}
    Flight(const Flight&) = delete;
    Flight& operator=(const Flight&) = delete;
    ~Flight() {
      const std::lock_guard<std::mutex> guard(keys_.mutex_);
      keys_.held_.erase(key_);
    }

   private:
    KeysInFlight& keys_;
    std::string key_;
  };

  /// Nothing where a request with this key is under way. Thread safe.
  [[nodiscard]] std::unique_ptr<Flight> take(const std::string& key) {
    const std::lock_guard<std::mutex> guard(mutex_);
    return held_.insert(key).second ? std::make_unique<Flight>(*this, key) : nullptr;
  }

 private:
  std::mutex mutex_;
  std::set<std::string> held_;
};

}  // namespace driftlab::server
