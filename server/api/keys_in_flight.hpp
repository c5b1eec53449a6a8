#pragma once
/// Idempotency keys whose requests are under way: of several requests with one key, whatever they ask, one runs, also
/// where several daemons have one store.
#include "server/store/coordination.hpp"

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
    ~Flight() { keys_.end(key_); }

   private:
    KeysInFlight& keys_;
    std::string key_;
  };

  /// Other daemons on the same store are asked as well. Before the first request; it must outlive this object.
  void share(SharedKeys* others) { others_ = others; }

  /// Nothing where a request with this key is under way. Errors: Io (other daemons cannot be asked). Thread safe.
  [[nodiscard]] Result<std::unique_ptr<Flight>> take(const std::string& key) {
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      if (!held_.insert(key).second) {
        return nullptr;
      }
    }
    const Result<bool> taken = others_ != nullptr ? others_->take_key(key) : Result<bool>(true);
    if (taken && *taken) {
      return std::make_unique<Flight>(*this, key);
    }
    forget(key);
    return taken ? Result<std::unique_ptr<Flight>>(nullptr) : fail(taken.error());
  }

 private:
  void forget(const std::string& key) {
    const std::lock_guard<std::mutex> guard(mutex_);
    held_.erase(key);
  }
  void end(const std::string& key) {
    if (others_ != nullptr) {
      others_->give_back_key(key);
    }
    forget(key);
  }

  SharedKeys* others_ = nullptr;
  std::mutex mutex_;
  std::set<std::string> held_;
};

}  // namespace driftlab::server
