#pragma once
/// Requests that are being answered: how many, and of which token. Thread safe.
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace driftlab::server {

class RequestsInFlight {
 public:
  /// `most`: of one token at a time.
  explicit RequestsInFlight(std::int64_t most) : most_(most) {}

  /// Counts its request until it is destroyed.
  class Place {
   public:
    Place(RequestsInFlight& all, std::string token) : all_(&all), token_(std::move(token)) {}
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;
    Place(Place&& other) noexcept : all_(std::exchange(other.all_, nullptr)), token_(std::move(other.token_)) {}
    Place& operator=(Place&&) = delete;
    ~Place() {
      if (all_ != nullptr) {
        all_->leave(token_);
      }
    }

   private:
    RequestsInFlight* all_;
    std::string token_;
  };

  /// A place for a request of that token; nothing where it has all it may have. Without a token (empty) there is always
  /// one.
  [[nodiscard]] std::optional<Place> enter(const std::string& token) {
    const std::lock_guard<std::mutex> guard(mutex_);
    std::int64_t& count = of_token_[token];
    if (!token.empty() && count >= most_) {
      return std::nullopt;
    }
    ++count;
    ++all_;
    return std::optional<Place>(std::in_place, *this, token);
  }

  /// Of everybody.
  [[nodiscard]] std::int64_t count() const {
    const std::lock_guard<std::mutex> guard(mutex_);
    return all_;
  }

 private:
  void leave(const std::string& token) {
    const std::lock_guard<std::mutex> guard(mutex_);
    --all_;
    if (const auto found = of_token_.find(token); --found->second == 0) {
      of_token_.erase(found);
    }
  }

  const std::int64_t most_;
  mutable std::mutex mutex_;
  std::map<std::string, std::int64_t> of_token_;
  std::int64_t all_ = 0;
};

}  // namespace driftlab::server
