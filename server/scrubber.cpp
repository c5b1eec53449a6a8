#include "server/scrubber.hpp"

#include "server/observe/log.hpp"
#include "server/store/guarded_round.hpp"

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <optional>
#include <vector>

namespace driftlab::server {
namespace {

/// Sleeps; false where the stop came first.
bool rest(const std::stop_token& stop, std::chrono::duration<double> time) {
  std::mutex mutex;
  std::condition_variable_any waiting;
  std::unique_lock<std::mutex> lock(mutex);
  waiting.wait_for(lock, stop, time, [] { return false; });
  return !stop.stop_requested();
}

Error damaged_columns(const std::string& sha256) {
  return {ErrorCode::Io,
          "The stored samples are damaged and cannot be made anew from the uploaded bytes; upload the same file again.",
          {{"blob", sha256}}};
}

}  // namespace

void Scrubber::start() {
  looking_ = std::jthread([this](const std::stop_token& stop) {
    using namespace std::chrono_literals;
    while (rest(stop, 3s)) {
      (void)guarded_round("scrubber", [&] { look_again(stop); });
    }
  });
  if (bytes_per_second_ > 0) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
}

void Scrubber::stop() {
  for (std::jthread* const thread : {&thread_, &looking_}) {
    thread->request_stop();
    if (thread->joinable()) {
      thread->join();
    }
  }
}

void Scrubber::note(const std::string& sha256, BlobState state) {
  const std::lock_guard<std::mutex> guard(mutex_);
  if (state == BlobState::Healed) {
    ++findings_.healed;
    log_warning("columns were made anew from the uploaded bytes", Json{{"blob", sha256}});
  }
  if (state == BlobState::Sound || state == BlobState::Healed) {
    damaged_.erase(sha256);
    states_.end(BadState::FileDamaged, sha256);
  } else {
    damaged_.insert(sha256);
    states_.begin(BadState::FileDamaged, "damage",
                  "A stored file has " + std::string(name_of(state)) + "; upload the same file again to heal it.",
                  sha256);
  }
  findings_.damaged = damaged_.size();
}

void Scrubber::note_damaged_row(const std::string& row) {
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    damaged_rows_.insert(row);
  }
  states_.begin(BadState::RowDamaged, "damage",
                "The row " + row + " of the database is not what was written; take it from a backup, or make it anew.",
                row);
}

Status Scrubber::verify_columns(const std::string& sha256) {
  const auto state = server::verify_columns(blobs_, sha256, limits_);
  if (!state) {
    return fail(state.error());
  }
  if (*state != BlobState::Sound) {
    note(sha256, *state);
  }
  if (*state == BlobState::DamagedColumns) {
    return fail(damaged_columns(sha256));
  }
  return {};
}

Status Scrubber::expect_sound_columns(const std::string& sha256) {
  constexpr std::uintmax_t kReadAtOnce = 64ULL << 20U;
  if (Status reached = blobs_.reach(sha256, BlobPart::Columns); !reached) {
    return reached;
  }
  std::error_code unknown;
  if (std::filesystem::file_size(blobs_.columns_path(sha256), unknown) <= kReadAtOnce && !unknown) {
    return verify_columns(sha256);
  }
  const std::lock_guard<std::mutex> guard(mutex_);
  return damaged_.contains(sha256) ? fail(damaged_columns(sha256)) : Status{};
}

Scrubber::Findings Scrubber::findings() const {
  const std::lock_guard<std::mutex> guard(mutex_);
  return findings_;
}

void Scrubber::run(const std::stop_token& stop) {
  using namespace std::chrono_literals;
  const ReadingPace pace = [&](std::size_t bytes) {
    {
      const std::lock_guard<std::mutex> guard(mutex_);
      findings_.bytes_read += bytes;
    }
    return rest(stop,
                std::chrono::duration<double>(static_cast<double>(bytes) / static_cast<double>(bytes_per_second_)));
  };
  while (rest(stop, 1s)) {
    bool mine = true;
    (void)guarded_round("scrubber", [&] { mine = read_all(stop, pace); });
    if (mine && !rest(stop, 60s)) {
      return;
    }
  }
}

bool Scrubber::read_all(const std::stop_token& stop, const ReadingPace& pace) {
  if (is_mine_ && !is_mine_()) {
    return false;
  }
  (void)guarded_round("scrubber", [&] { read_rows(stop, pace); });
  const auto hashes = store_.blob_hashes();
  for (const std::string& sha256 : hashes.value_or(std::vector<std::string>{})) {
    (void)guarded_round("scrubber", [&] { read_back(sha256, stop, pace); });
    if (stop.stop_requested()) {
      return true;
    }
  }
  const std::lock_guard<std::mutex> guard(mutex_);
  ++findings_.passes;
  return true;
}

void Scrubber::read_rows(const std::stop_token& stop, const ReadingPace& pace) {
  std::set<std::string> before;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    before = damaged_rows_;
  }
  std::set<std::string> found;
  const ReadingPace rows = [&](std::size_t bytes) { return pace(bytes) && !stop.stop_requested(); };
  const Status read = store_.read_back_rows(rows, [&](const std::string& row) {
    found.insert(row);
    note_damaged_row(row);
  });
  if (!read) {
    return;  // what was not read may be as damaged as it was
  }
  for (const std::string& row : before) {
    if (!found.contains(row)) {
      end(row);
    }
  }
}

void Scrubber::end(const std::string& row) {
  const std::lock_guard<std::mutex> guard(mutex_);
  damaged_rows_.erase(row);
  states_.end(BadState::RowDamaged, row);
}

void Scrubber::look_again(const std::stop_token& stop) {
  std::set<std::string> known;
  {
    const std::lock_guard<std::mutex> guard(mutex_);
    known = damaged_rows_;
  }
  for (const std::string& row : known) {
    const auto damaged = store_.is_damaged(row);
    if (damaged && *damaged == std::optional(false)) {
      end(row);
    }
    if (stop.stop_requested()) {
      return;
    }
  }
}

void Scrubber::read_back(const std::string& sha256, const std::stop_token& stop, const ReadingPace& pace) {
  const auto state = verify_blob(blobs_, sha256, limits_, pace);
  if (stop.stop_requested()) {
    return;
  }
  const auto row = store_.blob(sha256);
  if (state && row && *row) {  // one that was removed meanwhile is no loss
    note(sha256, *state);
    if (*state == BlobState::Sound || *state == BlobState::Healed) {
      (void)mend_pyramid(blobs_, sha256, pace);  // traces are slower without it, and right
    }
  }
}

}  // namespace driftlab::server
