#include "server/jobs/job_cost.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>

namespace driftlab::server {
namespace {

/// What the machine has, or what the control group allows where that is less.
std::int64_t memory_of_process() {
  const std::int64_t machine = std::int64_t{::sysconf(_SC_PHYS_PAGES)} * ::sysconf(_SC_PAGESIZE);
  std::ifstream limit("/sys/fs/cgroup/memory.max");
  std::int64_t allowed = 0;
  return limit >> allowed && allowed > 0 ? std::min(machine, allowed) : machine;
}

}  // namespace

std::vector<RecordingSize> sizes_of(const Json& recordings, Store& store) {
  std::vector<RecordingSize> sizes;
  for (const Json& entry : recordings) {
    RecordingSize& size = sizes.emplace_back();
    const auto recording = store.recording(entry.value("id", ""));
    const auto found = recording ? store.blob(recording->blob_sha256) : Result<std::optional<Blob>>(std::nullopt);
    if (const std::optional<Blob> blob = found.value_or(std::nullopt)) {
      const auto names = parse_json(blob->columns_json);
      size.rows = blob->rows;
      size.columns = names ? static_cast<std::int64_t>(names->size()) : 1;
    }
  }
  return sizes;
}

std::int64_t memory_for_jobs(const Budgets& budgets) {
  static const std::int64_t half = memory_of_process() / 2;
  return budgets.job_memory_bytes > 0 ? budgets.job_memory_bytes : half;
}

Status admit_cost(const JobCost& cost, const Budgets& budgets, int computing) {
  const double threads = computing > 0 ? computing : std::max(1U, std::thread::hardware_concurrency());
  const double seconds = cost.seconds + cost.shared_seconds / threads;
  const std::int64_t most = memory_for_jobs(budgets);
  constexpr std::int64_t kMebi = std::int64_t{1} << 20;
  if (cost.memory_bytes > most) {
    return fail(ErrorCode::LimitExceeded, "The job would take about " + std::to_string(cost.memory_bytes / kMebi) +
                                              " MiB of memory, and all jobs together have " +
                                              std::to_string(most / kMebi) + " MiB " +
                                              naming_budget("job_memory_bytes", most) + ".");
  }
  if (seconds > static_cast<double>(budgets.job_seconds)) {
    return fail(ErrorCode::LimitExceeded,
                "The job would take about " + std::to_string(static_cast<std::int64_t>(seconds)) + " s " +
                    naming_budget("job_seconds", budgets.job_seconds) + "; ask for less of it at once.");
  }
  return {};
}

MemoryGate::Share::Share(MemoryGate& gate, std::int64_t bytes, const std::stop_token& stop,
                         const std::function<void()>& waiting)
    : gate_(gate), bytes_(std::clamp<std::int64_t>(bytes, 0, gate.whole_)) {
  std::unique_lock<std::mutex> lock(gate_.mutex_);
  gate_.queue_.push_back(this);
  const auto my_turn = [this] { return gate_.queue_.front() == this && gate_.left_ >= bytes_; };
  if (!my_turn() && waiting) {
    lock.unlock();
    waiting();
    lock.lock();
  }
  held_ = gate_.changed_.wait(lock, stop, my_turn);
  std::erase(gate_.queue_, this);
  if (held_) {
    gate_.left_ -= bytes_;
  }
  lock.unlock();
  gate_.changed_.notify_all();
}

MemoryGate::Share::~Share() {
  if (held_) {
    const std::lock_guard<std::mutex> guard(gate_.mutex_);
    gate_.left_ += bytes_;
  }
  gate_.changed_.notify_all();
}

}  // namespace driftlab::server
