#pragma once
/// Answers that were given before, for as long as no row of the store has changed since.
///
/// An answer that depends on the rows of the store alone (`Route::from_rows`) is kept with the number of changes that
/// the store had counted before its first row was read (`Store::changes`). It is given again only while that number
/// stands, so that whoever was told that a change is stored reads it in every later answer. Whoever asks is part of
/// the key: a token that is limited to devices never gets the answer of another.
///
/// The first request at a later number removes all earlier answers: they can never be given again, and under a mixed
/// load they would fill the budget.
///
/// The least recently used answers go first where the budget `answer_cache_bytes` is spent. Thread safe.
#include "server/http/message.hpp"

#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

namespace driftlab::server {

class AnswerCache {
 public:
  /// At most `bytes` of bodies and keys; 0 keeps nothing.
  explicit AnswerCache(std::size_t bytes) : budget_(bytes) {}

  /// The answer that was kept under the key at that number of changes; nullptr where there is none.
  [[nodiscard]] std::shared_ptr<const Response> find(const std::string& key, std::uint64_t changes);
  void keep(const std::string& key, std::uint64_t changes, const Response& response);

  /// What is kept now, for the budget.
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Entry {
    std::string key;
    std::size_t bytes = 0;
    std::shared_ptr<const Response> response;
  };
  using Entries = std::list<Entry>;
  void forget_before(std::uint64_t changes);
  void remove(Entries::iterator entry);

  const std::size_t budget_;
  mutable std::mutex mutex_;
  std::uint64_t changes_ = 0;  ///< the number of every entry
  Entries entries_;            ///< the most recently used first
  std::unordered_map<std::string, Entries::iterator> by_key_;
  std::size_t bytes_ = 0;
};

/// Everything that an answer from rows depends on beside the rows: target, media type and who asks.
[[nodiscard]] std::string answer_key(const Request& request);

}  // namespace driftlab::server
