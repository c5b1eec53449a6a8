#include "server/store/bad_states.hpp"

#include "server/store/told_error.hpp"

#include <array>

namespace driftlab::server {
namespace {

constexpr UtcMicros kPassesAfter = 300'000'000;
constexpr std::size_t kMostDue = 1000;  // rows that wait for a store that cannot be written

}  // namespace

std::string_view name_of(BadState state) {
  constexpr std::array<std::string_view, 9> kNames{"store_silent",     "store_unwritable", "blobs_silent",
                                                   "disk_nearly_full", "files_fail",       "file_damaged",
                                                   "row_damaged",      "backups_fail",     "writes_lost"};
  return kNames.at(static_cast<std::size_t>(state));
}

const std::vector<BadState>& all_bad_states() {
  static const std::vector<BadState> all{BadState::StoreSilent,    BadState::StoreUnwritable, BadState::BlobsSilent,
                                         BadState::DiskNearlyFull, BadState::FilesFail,       BadState::FileDamaged,
                                         BadState::RowDamaged,     BadState::BackupsFail,     BadState::WritesLost};
  return all;
}

const std::vector<std::string_view>& causes_of_bad_states() {
  static const std::vector<std::string_view> all{"io", "disk_full", "damage"};
  return all;
}

std::string_view cause_of(const Error& error) { return error.code == ErrorCode::DiskFull ? "disk_full" : "io"; }

void BadStates::begin(BadState state, std::string_view cause, std::string detail, std::string object) {
  const StandingState begun{state, std::move(object), cause, std::move(detail), clock_.now()};
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    const auto found = standing_.find({state, begun.object});
    if (found != standing_.end() && found->second.cause == cause) {
      return;
    }
    const std::string told = without_paths({ErrorCode::Io, begun.detail, {}}).message;
    if (due_.size() < kMostDue) {
      due_.push_back(
          {"state.begin", begun.object.empty() ? std::string(name_of(state)) : begun.object,
           std::string(name_of(state)) + ", " + std::string(cause) + ", since " + rfc3339(begun.since) + ": " + told});
    }
    standing_[{state, begun.object}] = begun;
  }
  if (listener_) {
    listener_(begun, true);
  }
}

void BadStates::take_out(std::map<Key, StandingState>::iterator found) {
  const StandingState& ended = found->second;
  if (due_.size() < kMostDue) {
    due_.push_back(
        {"state.end", ended.object.empty() ? std::string(name_of(ended.state)) : ended.object,
         std::string(name_of(ended.state)) + ", " + std::string(ended.cause) + ", at " + rfc3339(clock_.now())});
  }
  standing_.erase(found);
}

void BadStates::end(BadState state, const std::string& object) {
  StandingState ended;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    const auto found = standing_.find({state, object});
    if (found == standing_.end()) {
      return;
    }
    ended = found->second;
    take_out(found);
  }
  if (listener_) {
    listener_(ended, false);
  }
}

void BadStates::note_failure(const Error& error) {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    failed_at_ = clock_.now();
  }
  begin(BadState::FilesFail, cause_of(error), error.message);
}

std::vector<StandingState> BadStates::standing() const {
  const std::lock_guard<std::mutex> guard(mutex_);
  std::vector<StandingState> all;
  all.reserve(standing_.size());
  for (const auto& [key, state] : standing_) {
    all.push_back(state);
  }
  return all;
}

void BadStates::look_after() {
  std::vector<Row> due;
  bool passed = false;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    passed = standing_.contains({BadState::FilesFail, ""}) && clock_.now() - failed_at_ > kPassesAfter;
  }
  if (passed) {
    end(BadState::FilesFail);
  }
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    due.swap(due_);
  }
  for (std::size_t i = 0; i < due.size(); ++i) {
    if (!recorder_(due[i].action, due[i].object, due[i].detail)) {
      const std::lock_guard<std::mutex> guard(mutex_);
      due_.insert(due_.begin(), due.begin() + static_cast<std::ptrdiff_t>(i), due.end());
      return;
    }
  }
}

}  // namespace driftlab::server
