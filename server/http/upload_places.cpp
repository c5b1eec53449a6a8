#include "server/http/upload_places.hpp"

#include <algorithm>
#include <tuple>

namespace driftlab::server {

std::optional<UploadPlaces::Number> UploadPlaces::join(const Asker& asker, Time now) {
  const std::lock_guard lock(mutex_);
  const auto whole =
      static_cast<std::int64_t>(std::min(asker.bytes, static_cast<std::uint64_t>(budgets_.upload_bytes)) /
                                static_cast<std::uint64_t>(budgets_.decode_bytes_per_second));
  const Number number = next_++;
  uploads_.emplace(number, Upload{asker.principal.empty() ? asker.address : asker.principal, asker.address,
                                  !exempt_(asker.address), now + std::chrono::seconds(whole)});
  give_places();
  const auto waiting = static_cast<std::int64_t>(uploads_.size()) - taken_;
  if (!uploads_.at(number).placed && waiting > budgets_.uploads_waiting) {
    uploads_.erase(number);
    return std::nullopt;
  }
  return number;
}

bool UploadPlaces::has_place(Number number) {
  const std::lock_guard lock(mutex_);
  const auto found = uploads_.find(number);
  return found != uploads_.end() && found->second.placed;
}

void UploadPlaces::leave(Number number) {
  const std::lock_guard lock(mutex_);
  const auto found = uploads_.find(number);
  if (found == uploads_.end()) {
    return;
  }
  if (found->second.placed) {
    --taken_;
    of_principal_.take(found->second.principal);
    of_address_.take(found->second.address);
  }
  uploads_.erase(found);
  give_places();
}

std::size_t UploadPlaces::taken() const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(taken_);
}

void UploadPlaces::Tally::take(const std::string& name) {
  const auto found = counts_.find(name);
  if (--found->second == 0) {
    counts_.erase(found);
  }
}

std::int64_t UploadPlaces::Tally::of(const std::string& name) const {
  const auto found = counts_.find(name);
  return found == counts_.end() ? 0 : found->second;
}

bool UploadPlaces::may_begin(const Upload& upload) const {
  return !upload.placed && (!upload.counted || of_address_.of(upload.address) < budgets_.uploads_per_address);
}

void UploadPlaces::give_places() {
  while (taken_ < budgets_.uploads) {
    Upload* next = nullptr;
    std::tuple<std::int64_t, Time> rank_of_next;
    for (auto& [number, upload] : uploads_) {  // by their numbers, so that of equals the first that came is kept
      if (!may_begin(upload)) {
        continue;
      }
      const std::tuple rank(of_principal_.of(upload.principal), upload.due);
      if (next == nullptr || rank < rank_of_next) {
        next = &upload;
        rank_of_next = rank;
      }
    }
    if (next == nullptr) {
      return;
    }
    next->placed = true;
    ++taken_;
    of_principal_.add(next->principal);
    of_address_.add(next->address);
  }
}

}  // namespace driftlab::server
