#pragma once
/// The places that uploads take: so many in all, so many of one address, and the next one goes to whoever has fewest.
///
/// An upload that finds no place waits for one, with its body unread. When a place is free it goes to the principal
/// who holds fewest; without tokens that is the address. Among equals the upload comes first that would be done first
/// if it had begun when it came and were decoded at the rate that the budgets ask for: a small one overtakes a large
/// one that came a little earlier, and none waits forever.
///
/// Thread safe. Whoever waits asks again when `kSubject` rings (server/http/bell.hpp).
#include "server/store/budgets.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace driftlab::server {

class UploadPlaces {
 public:
  /// What the bell rings for when a place was given back.
  static constexpr std::string_view kSubject = "upload places";

  using Time = std::chrono::steady_clock::time_point;
  using Number = std::uint64_t;

  struct Asker {
    std::string principal;    ///< id of the token; empty: told apart by the address
    std::string address;      ///< whose budget counts
    std::uint64_t bytes = 0;  ///< of the body, as declared; 0 where it is not
  };

  /// `exempt`: addresses whose uploads are not counted, as those of this machine.
  UploadPlaces(const Budgets& budgets, std::function<bool(const std::string&)> exempt)
      : budgets_(budgets), exempt_(std::move(exempt)) {}

  /// Takes a place in the queue. Nothing where too many wait already (`uploads_waiting`).
  [[nodiscard]] std::optional<Number> join(const Asker& asker, Time now);
  /// Whether the upload of that number has its place.
  [[nodiscard]] bool has_place(Number number);
  /// Gives the place back, or leaves the queue.
  void leave(Number number);

  /// How many have a place.
  [[nodiscard]] std::size_t taken() const;

 private:
  struct Upload {
    std::string principal;
    std::string address;
    bool counted = true;  ///< the address has a budget
    Time due{};           ///< when it would be done if it had begun at once
    bool placed = false;
  };
  /// How many places each name holds; a name without one is not kept.
  class Tally {
   public:
    void add(const std::string& name) { ++counts_[name]; }
    void take(const std::string& name);
    [[nodiscard]] std::int64_t of(const std::string& name) const;

   private:
    std::unordered_map<std::string, std::int64_t> counts_;
  };
  [[nodiscard]] bool may_begin(const Upload& upload) const;
  void give_places();

  const Budgets& budgets_;
  std::function<bool(const std::string&)> exempt_;
  mutable std::mutex mutex_;
  Number next_ = 1;
  std::int64_t taken_ = 0;
  std::map<Number, Upload> uploads_;
  Tally of_principal_;
  Tally of_address_;
};

}  // namespace driftlab::server
