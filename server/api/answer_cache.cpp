#include "server/api/answer_cache.hpp"

#include <utility>

namespace driftlab::server {
namespace {

/// What an entry takes beside the text of its body and key: nodes of list and map, headers.
constexpr std::size_t kEntryOverhead = 512;

}  // namespace

std::shared_ptr<const Response> AnswerCache::find(const std::string& key, std::uint64_t changes) {
  const std::lock_guard guard(mutex_);
  forget_before(changes);
  const auto found = by_key_.find(key);
  if (found == by_key_.end() || changes < changes_) {
    return nullptr;
  }
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->response;
}

void AnswerCache::keep(const std::string& key, std::uint64_t changes, const Response& response) {
  const std::size_t bytes = response.body.size() + 2 * key.size() + kEntryOverhead;
  if (bytes > budget_ / 4) {
    return;  // one large answer must not drive out all others
  }
  auto kept = std::make_shared<const Response>(response);
  const std::lock_guard guard(mutex_);
  forget_before(changes);
  if (changes < changes_) {
    return;  // it was long in the making: the store has changed since
  }
  if (const auto known = by_key_.find(key); known != by_key_.end()) {
    remove(known->second);
  }
  while (!entries_.empty() && bytes_ + bytes > budget_) {
    remove(std::prev(entries_.end()));
  }
  entries_.push_front(Entry{key, bytes, std::move(kept)});
  by_key_.emplace(key, entries_.begin());
  bytes_ += bytes;
}

std::size_t AnswerCache::bytes() const {
  const std::lock_guard guard(mutex_);
  return bytes_;
}

void AnswerCache::forget_before(std::uint64_t changes) {
  if (changes > changes_) {
    by_key_.clear();
    entries_.clear();
    bytes_ = 0;
    changes_ = changes;
  }
}

void AnswerCache::remove(Entries::iterator entry) {
  bytes_ -= entry->bytes;
  by_key_.erase(entry->key);
  entries_.erase(entry);
}

std::string answer_key(const Request& request) {
  std::string key = request.target;
  for (const std::string_view part :
       {request.header("accept").value_or(""), std::string_view(request.caller.principal.token)}) {
    key += '\n';
    key += part;
  }
  return key;
}

}  // namespace driftlab::server
